# cmake -D... -P PlayInGui.cmake script: plays a recorded test in ParaView.
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
set(ENV{HOME} "${home}")
set(ENV{XDG_CONFIG_HOME} "${home}")

get_filename_component(plugin_folder "${PLUGIN}" DIRECTORY)
get_filename_component(plugin_name "${PLUGIN}" NAME_WE)
execute_process(
  COMMAND "${PARAVIEW}" "--plugin-search-paths=${plugin_folder}" "--plugins=${plugin_name}"
    "--data-directory=${DATA}" "--baseline-directory=${BASELINE}" "--test-directory=${OUTPUT}"
    "--test-script=${script}" --exit
  RESULT_VARIABLE result)
if (result)
  message(FATAL_ERROR "ParaView returned ${result}")
endif ()
