# Wheels: scikit-build-core defines SKBUILD and installs into the root of site-packages. The
# library lies in the package vtkcartan, beside the extension module, and finds VTK's
# libraries in the package vtkmodules.
set(CMAKE_INSTALL_LIBDIR vtkcartan)
set(CARTAN_PYTHON_DESTINATION "." CACHE STRING "" FORCE)
set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/../vtkmodules")
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH OFF)

# VTK's wheels for this platform are built with the old binary interface of libstdc++.
if (CMAKE_SYSTEM_NAME STREQUAL "Linux" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  add_compile_definitions(_GLIBCXX_USE_CXX11_ABI=0)
endif ()
