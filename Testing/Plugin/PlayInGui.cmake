# cmake -D... -P PlayInGui.cmake script: plays a recorded test in ParaView. If the test has saved a
# trace and states (gui_testing.py), they are replayed without the window. ParaView is connected to
# a pvserver if the name of the script begins with Remote.
#
# ParaView starts with settings of its own, made anew, so that nothing depends
# on the user or on the run before. Untold, it would open with a welcome dialog
# and wait for a click.
math(EXPR last "${CMAKE_ARGC} - 1")
set(script "${CMAKE_ARGV${last}}")
get_filename_component(name "${script}" NAME_WE)
set(home "${OUTPUT}/${name}-home")
file(REMOVE_RECURSE "${home}")
file(WRITE "${home}/ParaView/ParaView${PARAVIEW_VERSION}.ini"
  "[General]\nGeneralSettings.ShowWelcomeDialog=false\n")
file(REMOVE_RECURSE "${OUTPUT}/${name}")
set(ENV{PYTHONPATH} "$ENV{PYTHONPATH}:${CMAKE_CURRENT_LIST_DIR}")
set(ENV{HOME} "${home}")
set(ENV{XDG_CONFIG_HOME} "${home}")

get_filename_component(plugin_folder "${PLUGIN}" DIRECTORY)
get_filename_component(plugin_name "${PLUGIN}" NAME_WE)
set(load "--plugin-search-paths=${plugin_folder}" "--plugins=${plugin_name}")
# The contents of the screen are in a file, for pictures of the window. Each run has a folder for
# it: the server of the run before may still be ending, and would delete the file of this one.
string(RANDOM LENGTH 8 run)
set(screen "${OUTPUT}/Screen/${name}")
file(REMOVE_RECURSE "${screen}")
file(MAKE_DIRECTORY "${screen}/${run}")
set(ENV{CARTAN_SCREEN} "${screen}/${run}/Xvfb_screen0")
set(draw "${XVFB_RUN}" -a -s)
set(size "-screen 0 1280x1024x24 -noreset")

set(serve "")
if (name MATCHES "^Remote")
  set(serve "${PYTHON}" "${CMAKE_CURRENT_LIST_DIR}/serve.py" "${PVSERVER}" ${load} --)
endif ()
execute_process(
  COMMAND ${draw} "${size} -fbdir ${screen}/${run}" ${serve} "${PARAVIEW}" ${load}
    "--data-directory=${DATA}" "--baseline-directory=${BASELINE}" "--test-directory=${OUTPUT}"
    "--test-script=${script}" --exit
  RESULT_VARIABLE result)
if (result)
  message(FATAL_ERROR "ParaView returned ${result}")
endif ()

if (EXISTS "${OUTPUT}/${name}/replay.json")
  foreach (saved IN ITEMS trace.py state.py state.pvsm)
    execute_process(
      COMMAND ${draw} "${size}" "${PVBATCH}" "${CMAKE_CURRENT_LIST_DIR}/replay.py" "${OUTPUT}/${name}" "${saved}"
      RESULT_VARIABLE result)
    if (result)
      message(FATAL_ERROR "${saved} cannot be replayed: ${result}")
    endif ()
  endforeach ()
endif ()
