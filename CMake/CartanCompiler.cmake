# How the stand-alone project compiles. Inside VTK, VTK decides.

get_property(is_multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if (NOT is_multi_config AND NOT CMAKE_BUILD_TYPE)
  # Eigen without optimization is fifty times slower: never by accident.
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, RelWithDebInfo, Debug" FORCE)
endif ()

find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if (CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif ()

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

# Only what the export macros name leaves the library; in particular not the
# Eigen instantiations, which other libraries in the process have as well.
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

# For code written here; generated wrappers are not ours to clean up. Off for users: a
# newer compiler has new warnings.
option(CARTAN_WARNINGS_AS_ERRORS "Refuse code with compiler warnings" OFF)
if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  set(CARTAN_WARNING_FLAGS -Wall -Wextra -Wshadow)
endif ()
if (CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False alarms inside Eigen, at some levels of optimization.
  list(APPEND CARTAN_WARNING_FLAGS -Wno-maybe-uninitialized)
endif ()
if (CARTAN_WARNINGS_AS_ERRORS)
  list(APPEND CARTAN_WARNING_FLAGS -Werror)
endif ()

# Most of the time goes into the same templates of Eigen, file by file. It is for builds
# that are made whole: a change compiles all that is in one unit with it again, and a missing
# include does not show.
option(CARTAN_COMPILE_TOGETHER "Compile some eight source files as one" OFF)

# cartan_compile_together(target groups files...)
#
# Puts the sources of a target into so many units, if that is asked for, but for these files,
# whose own names are those of others. The unit follows from a file's name alone, so that a new
# file does not shuffle the others.
function (cartan_compile_together target groups)
  if (NOT CARTAN_COMPILE_TOGETHER)
    return ()
  endif ()
  get_target_property(sources "${target}" SOURCES)
  foreach (source IN LISTS sources)
    get_filename_component(name "${source}" NAME)
    if (name IN_LIST ARGN)
      continue ()
    endif ()
    string(MD5 hash "${name}")
    string(SUBSTRING "${hash}" 0 4 hash)
    math(EXPR group "0x${hash} % ${groups}")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${group}")
  endforeach ()
  set_target_properties("${target}" PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction ()

set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")

# Installed libraries find a VTK outside the system's folders.
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
