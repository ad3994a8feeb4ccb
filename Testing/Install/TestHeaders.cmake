# The installed headers are those of the public classes, in a folder of their own.
#
#   cmake -DPREFIX=... -DFILTERS=... -P TestHeaders.cmake
file(GLOB folders RELATIVE "${PREFIX}/include" "${PREFIX}/include/*")
if (NOT folders STREQUAL "vtkCartan")
  message(FATAL_ERROR "include/ has ${folders} instead of vtkCartan")
endif ()
file(GLOB_RECURSE installed RELATIVE "${PREFIX}/include/vtkCartan" "${PREFIX}/include/vtkCartan/*")
file(GLOB expected RELATIVE "${FILTERS}" "${FILTERS}/vtk*.h")
list(APPEND expected vtkCartanModule.h) # the export macro
list(SORT installed)
list(SORT expected)
if (NOT installed STREQUAL expected)
  message(FATAL_ERROR "include/vtkCartan has\n${installed}\ninstead of\n${expected}")
endif ()
