# What the tests share: the scanned meshes, the folders, the way to run a script.

set(CARTAN_TEST_OUTPUT "${PROJECT_BINARY_DIR}/Testing/Output")
set(CARTAN_BASELINE_DIR "${PROJECT_SOURCE_DIR}/Data/Baseline")
file(MAKE_DIRECTORY "${CARTAN_TEST_OUTPUT}")

# CGAL's example meshes are under various licenses: they are taken from the
# package libcgal-demo and never become part of this repository.
set(CARTAN_MESH_DIR "" CACHE PATH "CGAL's data/meshes; empty: unpacked from libcgal-demo")
if (NOT CARTAN_MESH_DIR)
  find_file(CARTAN_MESH_ARCHIVE data.tar.gz PATHS /usr/share/doc/libcgal-dev NO_DEFAULT_PATH)
  mark_as_advanced(CARTAN_MESH_ARCHIVE)
  if (NOT CARTAN_MESH_ARCHIVE)
    message(FATAL_ERROR "The tests and benchmarks need CGAL's example meshes: "
      "/usr/share/doc/libcgal-dev/data.tar.gz of Debian's package libcgal-demo is not there. "
      "Run Utilities/bootstrap.sh, which installs it on slim images too, or set CARTAN_MESH_DIR.")
  endif ()
  set(CARTAN_MESH_DIR "${PROJECT_BINARY_DIR}/MeshData")
  if (NOT EXISTS "${CARTAN_MESH_DIR}")
    set(unpacked "${PROJECT_BINARY_DIR}/MeshDataUnpacked")
    file(ARCHIVE_EXTRACT INPUT "${CARTAN_MESH_ARCHIVE}" DESTINATION "${unpacked}"
      PATTERNS "data/meshes/*.off")
    file(RENAME "${unpacked}/data/meshes" "${CARTAN_MESH_DIR}")
    file(REMOVE_RECURSE "${unpacked}")
  endif ()
endif ()

# The same locations for C++ (compile definitions) and for scripts (environment).
set(cartan_test_locations
  "CARTAN_MESH_DIR=${CARTAN_MESH_DIR}"
  "CARTAN_DATA_DIR=${PROJECT_SOURCE_DIR}/Data"
  "CARTAN_BASELINE_DIR=${CARTAN_BASELINE_DIR}"
  "CARTAN_TEST_OUTPUT=${CARTAN_TEST_OUTPUT}")
list(TRANSFORM cartan_test_locations REPLACE "=(.*)" "=\"\\1\"" OUTPUT_VARIABLE CARTAN_TEST_DEFINITIONS)

# How VTK reports an error that nobody observed.
set(CARTAN_ERROR_REGEX "(^|\n)ERROR: |ERR\\|")

set(CARTAN_SCRIPT_ENVIRONMENT ${cartan_test_locations})
if (CARTAN_WRAP_PYTHON)
  list(APPEND CARTAN_SCRIPT_ENVIRONMENT
    "PYTHONPATH=${PROJECT_BINARY_DIR}/${CARTAN_PYTHON_DESTINATION}:${PROJECT_SOURCE_DIR}/Testing/Python")
endif ()
if (CARTAN_BUILD_PLUGIN)
  list(APPEND CARTAN_SCRIPT_ENVIRONMENT "CARTAN_PLUGIN=$<TARGET_FILE:CartanPlugin>")
endif ()

find_program(CARTAN_PVPYTHON pvpython HINTS "${VTK_PREFIX_PATH}/bin")
find_program(CARTAN_PVBATCH pvbatch HINTS "${VTK_PREFIX_PATH}/bin")
find_program(CARTAN_PVSERVER pvserver HINTS "${VTK_PREFIX_PATH}/bin")
find_program(CARTAN_PARAVIEW paraview HINTS "${VTK_PREFIX_PATH}/bin")
find_program(CARTAN_XVFB_RUN xvfb-run)
mark_as_advanced(CARTAN_PVPYTHON CARTAN_PVBATCH CARTAN_PVSERVER CARTAN_PARAVIEW CARTAN_XVFB_RUN)
# A screen of its own for each test that draws. VTK probes the screen with a
# connection that it closes again; without -noreset the server would then start
# over, and lose the next connection if it comes too soon.
set(CARTAN_WITH_SCREEN "${CARTAN_XVFB_RUN}" -a -s "-screen 0 1280x1024x24 -noreset")

# cartan_add_script_tests([MAY_PRINT_ERRORS]
#   LABEL label SCRIPTS script... COMMAND command...)
#
# One test, named label.Script, for each script: the command with the script
# appended.
function (cartan_add_script_tests)
  cmake_parse_arguments(PARSE_ARGV 0 arg "MAY_PRINT_ERRORS" "LABEL" "SCRIPTS;COMMAND")
  foreach (script IN LISTS arg_SCRIPTS)
    get_filename_component(name "${script}" NAME_WE)
    set(test "${arg_LABEL}.${name}")
    add_test(NAME "${test}" COMMAND ${arg_COMMAND} "${script}")
    set_tests_properties("${test}" PROPERTIES
      LABELS      "${arg_LABEL}"
      ENVIRONMENT "${CARTAN_SCRIPT_ENVIRONMENT}"
      TIMEOUT     "${CARTAN_TEST_TIMEOUT}"
      # One rank that fails leaves the others waiting.
      TIMEOUT_AFTER_MATCH "10;Traceback \\(most recent call last\\)")
    if (NOT arg_MAY_PRINT_ERRORS)
      set_tests_properties("${test}" PROPERTIES FAIL_REGULAR_EXPRESSION "${CARTAN_ERROR_REGEX}")
    endif ()
  endforeach ()
endfunction ()
