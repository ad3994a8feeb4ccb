# Debian packages: `cpack -G DEB` in the build folder.
#
#   libvtkcartan            library, headers, CMake package
#   python3-vtkcartan       the Python package
#   paraview-plugin-cartan  the plugin, which all programs of ParaView load
#
# The preset "debian" builds them with Debian's folders, and without CHOLMOD, so that they
# are under the BSD license.
set(CPACK_PACKAGE_NAME cartan)
set(CPACK_PACKAGE_VENDOR "Cartan")
set(CPACK_PACKAGE_CONTACT "Cartan's developers <cartan@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Finds ParaView in exactly this version too.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The packages' own library, which the system does not know.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")

set(same "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libvtkcartan)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/Packaging/Debian/triggers")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vtkcartan)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "libvtkcartan ${same}, python3-paraview, python3-numpy")
set(CPACK_DEBIAN_PLUGIN_PACKAGE_NAME paraview-plugin-cartan)
set(CPACK_DEBIAN_PLUGIN_PACKAGE_DEPENDS "libvtkcartan ${same}")
set(CPACK_DEBIAN_PLUGIN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CARTAN_PLUGINS_FILE "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/cartan.plugins.xml")
foreach (script IN ITEMS postinst prerm)
  configure_file("${PROJECT_SOURCE_DIR}/Packaging/Debian/${script}.in"
    "${PROJECT_BINARY_DIR}/Packaging/${script}" @ONLY FILE_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  list(APPEND CPACK_DEBIAN_PLUGIN_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/Packaging/${script}")
endforeach ()

# Each package carries the license, where Debian looks for it.
foreach (entry IN ITEMS "runtime libvtkcartan" "python python3-vtkcartan"
    "paraview_plugins paraview-plugin-cartan")
  string(REGEX MATCH "^([^ ]+) (.+)$" matched "${entry}")
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" COMPONENT "${CMAKE_MATCH_1}"
    DESTINATION "share/doc/${CMAKE_MATCH_2}" RENAME copyright)
endforeach ()

set(CPACK_DEBIAN_LIBRARY_DESCRIPTION
  "deform, morph and measure triangle surfaces in VTK
Surfaces are described by their local shape instead of by coordinates.
This package has the library, its headers and the CMake package vtkCartan.")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION
  "deform, morph and measure triangle surfaces in Python
Surfaces are described by their local shape instead of by coordinates.
This package has the classes, and functions for arrays of numpy.")
set(CPACK_DEBIAN_PLUGIN_DESCRIPTION
  "deform, morph and measure triangle surfaces in ParaView
Surfaces are described by their local shape instead of by coordinates.
This package has the plugin, which paraview, pvpython, pvbatch and pvserver
load.")

include(CPack)
foreach (group IN ITEMS library python plugin)
  cpack_add_component_group(${group})
endforeach ()
foreach (component IN ITEMS runtime development licenses)
  cpack_add_component(${component} GROUP library)
endforeach ()
cpack_add_component(python GROUP python)
cpack_add_component(paraview_plugins GROUP plugin)
