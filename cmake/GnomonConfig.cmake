# find_package(Gnomon): gnomon::shadow, gnomon::omni, gnomon::vsv and the layers below them, gnomon::lab above.
# What they stand on is what the project's own CMakeLists.txt asks for.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Vulkan)
find_dependency(glslang)
find_dependency(glm)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(TinyGLTF)
find_dependency(OpenImageIO)
find_dependency(embree 3)
find_dependency(TBB)
find_path(OPENVDB_MODULE_DIR FindOpenVDB.cmake
  PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB lib64/cmake/OpenVDB REQUIRED)
list(PREPEND CMAKE_MODULE_PATH ${OPENVDB_MODULE_DIR})
find_dependency(OpenVDB 10)
list(POP_FRONT CMAKE_MODULE_PATH)
include(${CMAKE_CURRENT_LIST_DIR}/GnomonTargets.cmake)
