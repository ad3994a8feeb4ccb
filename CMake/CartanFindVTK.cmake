# Finds ParaView, if the plugin is wanted, and the VTK to build against.
#
# Only what is used is requested, because each component brings along the
# development packages of everything it depends on.
set(paraview_components RemotingCore pqApplicationComponents)
set(vtk_components
  CommonCore CommonDataModel CommonExecutionModel CommonMath CommonSystem
  FiltersCore FiltersExtraction IOCore ParallelCore
  CommonComputationalGeometry CommonTransforms FiltersGeometry FiltersModeling FiltersSources IOXML # the tests
  TestingCore
  WrappingPythonCore)

if (NOT DEFINED CARTAN_BUILD_PLUGIN)
  find_package(ParaView 5.11 QUIET COMPONENTS ${paraview_components})
endif ()
option(CARTAN_BUILD_PLUGIN "Build the ParaView plugin" "${ParaView_FOUND}")

if (CARTAN_BUILD_PLUGIN)
  find_package(ParaView 5.11 REQUIRED COMPONENTS ${paraview_components})
  # Part of what pqApplicationComponents links, but not found along with it.
  list(APPEND vtk_components netcdf xdmf3)
else ()
  find_package(VTK 9.1 QUIET COMPONENTS ${vtk_components})
  if (NOT VTK_FOUND)
    # ParaView carries a VTK package of its own, in a folder where only
    # ParaView's package looks for it; that sets VTK_DIR.
    find_package(ParaView 5.11 QUIET COMPONENTS RemotingCore)
  endif ()
endif ()
find_package(VTK 9.1 REQUIRED COMPONENTS ${vtk_components}
  OPTIONAL_COMPONENTS
    PythonInterpreter   # the plugin's, for traces
    InteractionWidgets ParallelMPI FiltersParallelDIY2) # the tests'
message(STATUS "VTK ${VTK_VERSION} in ${VTK_DIR}; ParaView plugin: ${CARTAN_BUILD_PLUGIN}")
