# The parts of the stand-alone project, one function each.

# The folders in the install tree, and in the same places in the build tree.
set(CARTAN_CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/vtkCartan")
if (VTK_WRAP_PYTHON)
  vtk_module_python_default_destination(destination)
  set(CARTAN_PYTHON_DESTINATION "${destination}" CACHE STRING
    "Where the Python package is installed, relative to the prefix")
  mark_as_advanced(CARTAN_PYTHON_DESTINATION)
endif ()

# The library. vtk_module_build() enters the folder of vtk.module again and
# names its build folder after CMAKE_BINARY_DIR; the change of that variable,
# local to this function, keeps it from being the one already in use.
function (cartan_build_module)
  vtk_module_scan(
    MODULE_FILES      "${CMAKE_CURRENT_SOURCE_DIR}/vtk.module"
    REQUEST_MODULES   vtkCartan::vtkCartan
    PROVIDES_MODULES  modules
    REQUIRES_MODULES  required_modules # imported by find_package(VTK)
    HIDE_MODULES_FROM_CACHE ON)

  set(CMAKE_BINARY_DIR "${CMAKE_BINARY_DIR}/Module")
  vtk_module_build(
    MODULES             ${modules}
    PACKAGE             vtkCartan
    INSTALL_EXPORT      vtkCartan
    HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/vtkCartan"
    CMAKE_DESTINATION   "${CARTAN_CMAKE_DESTINATION}"
    TEST_DIRECTORY_NAME NONE # the tests come last, when the plugin is there
    VERSION             "${PROJECT_VERSION}"
    SOVERSION           "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
endfunction ()

# The Python package `vtkcartan`.
function (cartan_wrap_python)
  vtk_module_wrap_python(
    MODULES             vtkCartan::vtkCartan
    TARGET              vtkCartanPythonWrapped
    PYTHON_PACKAGE      vtkcartan
    MODULE_DESTINATION  "${CARTAN_PYTHON_DESTINATION}"
    LIBRARY_DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    CMAKE_DESTINATION   "${CARTAN_CMAKE_DESTINATION}"
    INSTALL_HEADERS     OFF)

  # The wrapped classes are in the extension module vtkcartan.vtkCartan; the package
  # hands them on, with functions for arrays.
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/Python/vtkcartan/*")
  list(FILTER sources EXCLUDE REGEX "__pycache__")
  foreach (source IN LISTS sources)
    get_filename_component(name "${source}" NAME)
    configure_file("${source}" "${CMAKE_BINARY_DIR}/${CARTAN_PYTHON_DESTINATION}/vtkcartan/${name}"
      COPYONLY)
  endforeach ()

  # Type stubs of the wrapped classes.
  find_package(Python3 QUIET REQUIRED COMPONENTS Interpreter)
  set(folder "${CMAKE_BINARY_DIR}/${CARTAN_PYTHON_DESTINATION}/vtkcartan")
  add_custom_command(OUTPUT "${folder}/vtkCartan.pyi"
    COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/CMake/generate_stubs.py"
      "${folder}" vtkCartan
    DEPENDS vtkCartanPython "${CMAKE_CURRENT_SOURCE_DIR}/CMake/generate_stubs.py"
    VERBATIM)
  add_custom_target(CartanStubs ALL DEPENDS "${folder}/vtkCartan.pyi")

  install(FILES ${sources} "${folder}/vtkCartan.pyi"
    DESTINATION "${CARTAN_PYTHON_DESTINATION}/vtkcartan" COMPONENT python)
endfunction ()

function (cartan_build_plugin)
  paraview_plugin_scan(
    PLUGIN_FILES      "${CMAKE_CURRENT_SOURCE_DIR}/Plugin/paraview.plugin"
    PROVIDES_PLUGINS  plugins
    ENABLE_BY_DEFAULT ON
    HIDE_PLUGINS_FROM_CACHE ON)
  paraview_plugin_build(
    PLUGINS              ${plugins}
    AUTOLOAD             CartanPlugin
    PLUGINS_FILE_NAME    cartan.plugins.xml
    PLUGINS_COMPONENT    paraview_plugins
    TARGET_COMPONENT     paraview_plugins
    RUNTIME_DESTINATION  "${CMAKE_INSTALL_BINDIR}"
    LIBRARY_DESTINATION  "${CMAKE_INSTALL_LIBDIR}"
    LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}")
endfunction ()

# What find_package(vtkCartan) reads.
function (cartan_install_package)
  include(CMakePackageConfigHelpers)
  configure_package_config_file(
    "${CMAKE_CURRENT_SOURCE_DIR}/CMake/vtkCartanConfig.cmake.in"
    "${CMAKE_CURRENT_BINARY_DIR}/CMake/vtkCartanConfig.cmake"
    INSTALL_DESTINATION "${CARTAN_CMAKE_DESTINATION}")
  write_basic_package_version_file(
    "${CMAKE_CURRENT_BINARY_DIR}/CMake/vtkCartanConfigVersion.cmake"
    COMPATIBILITY SameMinorVersion)
  install(
    FILES
      "${CMAKE_CURRENT_BINARY_DIR}/CMake/vtkCartanConfig.cmake"
      "${CMAKE_CURRENT_BINARY_DIR}/CMake/vtkCartanConfigVersion.cmake"
    DESTINATION "${CARTAN_CMAKE_DESTINATION}"
    COMPONENT   development)
endfunction ()
