# find_package(Gnomon [COMPONENTS shadow omni vsv media ...]): gnomon::shadow and so on, with what they link and no more.
# A component is a library by its name (GnomonLibraries.cmake lists them); without components all of them are found.
#
# Those for a renderer of its own: shadow (maps and their look-up), planar (spot and directional), omni (cube and
# paraboloid), vsv (shadow volumes), media (light shafts). They ask for glm, fmt, Vulkan and glslang, and from omni on
# oneTBB. judge and what is above it ask for Embree, OpenImageIO and the rest.
include(CMakeFindDependencyMacro)
include(${CMAKE_CURRENT_LIST_DIR}/GnomonLibraries.cmake)

set(gnomon_wanted ${Gnomon_FIND_COMPONENTS})
if(NOT gnomon_wanted)
  set(gnomon_wanted ${gnomon_libraries})
endif()
foreach(component IN LISTS gnomon_wanted)
  if(NOT component IN_LIST gnomon_libraries)
    set(Gnomon_FOUND FALSE)
    list(JOIN gnomon_libraries ", " names)
    set(Gnomon_NOT_FOUND_MESSAGE "Gnomon has no component '${component}'; it has ${names}")
    return()
  endif()
endforeach()

# With what they link: gnomon_libraries lists what is linked before what links it.
set(gnomon_found "")
set(reversed ${gnomon_libraries})
list(REVERSE reversed)
foreach(library IN LISTS reversed)
  if(library IN_LIST gnomon_wanted)
    list(PREPEND gnomon_found ${library})
    list(APPEND gnomon_wanted ${gnomon_libraries_of_${library}})
  endif()
endforeach()
foreach(library IN LISTS gnomon_found)
  foreach(package IN LISTS gnomon_packages_of_${library})
    if(package STREQUAL "embree")
      find_dependency(embree 3)
    elseif(package STREQUAL "SQLite")
      find_dependency(SQLite3)
    elseif(package STREQUAL "OpenVDB")
      # It comes with a find module of its own, which stays out of the way of everything else's.
      find_path(OPENVDB_MODULE_DIR FindOpenVDB.cmake
        PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB lib64/cmake/OpenVDB REQUIRED)
      list(PREPEND CMAKE_MODULE_PATH ${OPENVDB_MODULE_DIR})
      find_dependency(OpenVDB 10)
      list(POP_FRONT CMAKE_MODULE_PATH)
    else()
      find_dependency(${package})
    endif()
  endforeach()
endforeach()
foreach(library IN LISTS gnomon_found)
  include(${CMAKE_CURRENT_LIST_DIR}/Gnomon_${library}.cmake)
endforeach()
foreach(component IN LISTS Gnomon_FIND_COMPONENTS)
  set(Gnomon_${component}_FOUND TRUE)
endforeach()
