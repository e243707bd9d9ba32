# gnomon_library(NAME LINKS ... SOURCES ...): one static library for the current folder.
#
# Headers are included as "<folder>/<file>.h", the folder as seen from the root or from src/ ("lab/core/setup.h"). Each
# library publishes an include directory that holds links to that folder's headers and to nothing else: a folder below
# with a CMakeLists.txt is a library of its own. So an include of a layer that is not linked does not resolve: the
# direction of the layers is enforced by the build. Installed, all of them stand below include/gnomon, and gnomon_shadow
# is gnomon::shadow.

# -ffp-contract=off: the shared mathematics must give the same bits in C++ and in the shaders.
add_library(gnomon_options INTERFACE)
set(warnings -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-float-conversion
    -Wno-missing-field-initializers -Werror)
target_compile_options(gnomon_options INTERFACE $<BUILD_INTERFACE:${warnings}> -ffp-contract=off)
target_compile_features(gnomon_options INTERFACE cxx_std_20)
target_compile_definitions(gnomon_options INTERFACE
  GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_FORCE_XYZW_ONLY GLM_FORCE_EXPLICIT_CTOR GLM_ENABLE_EXPERIMENTAL)
if(GNOMON_SANITIZE)
  target_compile_options(gnomon_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(gnomon_options INTERFACE -fsanitize=address,undefined)
endif()
# Every library counts which branches it takes, for tests/fuzz: libFuzzer's own main is linked there alone.
if(GNOMON_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "GNOMON_FUZZ needs clang++: configure with -DCMAKE_CXX_COMPILER=clang++")
  endif()
  target_compile_options(gnomon_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# For find_package(Gnomon).
function(gnomon_install name)
  string(REPLACE gnomon_ "" export_name ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${export_name})
  install(TARGETS ${name} EXPORT GnomonTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/gnomon)
endfunction()
gnomon_install(gnomon_options)

# gnomon_headers(DIR FOLDER): links to the headers of the current folder, and of those below that are no library of their
# own, as DIR/FOLDER; and what to install.
function(gnomon_headers dir folder)
  file(REMOVE_RECURSE ${dir})
  file(MAKE_DIRECTORY ${dir}/${folder})
  file(GLOB entries CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*)
  foreach(entry IN LISTS entries)
    get_filename_component(name ${entry} NAME)
    if(IS_DIRECTORY ${entry} AND NOT EXISTS ${entry}/CMakeLists.txt)
      file(CREATE_LINK ${entry} ${dir}/${folder}/${name} SYMBOLIC)
      install(DIRECTORY ${entry} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gnomon/${folder} FILES_MATCHING PATTERN "*.h")
    elseif(name MATCHES "\\.h$")
      file(CREATE_LINK ${entry} ${dir}/${folder}/${name} SYMBOLIC)
      install(FILES ${entry} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gnomon/${folder})
    endif()
  endforeach()
endfunction()

function(gnomon_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "^src/" "" folder ${folder})
  set(include_dir ${CMAKE_BINARY_DIR}/include/${name})
  gnomon_headers(${include_dir} ${folder})
  add_library(${name} STATIC ${arg_SOURCES})
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${include_dir}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/gnomon>)
  target_link_libraries(${name} PUBLIC gnomon_options ${arg_LINKS} PRIVATE ${arg_PRIVATE_LINKS})
  if(name STREQUAL gnomon_base)
    target_precompile_headers(${name} PRIVATE
      <algorithm> <array> <cmath> <cstdint> <filesystem> <memory> <optional> <span> <string>
      <string_view> <vector> <glm/glm.hpp> <fmt/format.h>)
  else()
    target_precompile_headers(${name} REUSE_FROM gnomon_base)
  endif()
  gnomon_install(${name})
endfunction()

# gnomon_unity(TARGET BATCH): compiles BATCH files of a target at a time, where reading CLI11 or JSON headers once a file
# costs more than the files themselves. Their unnamed namespaces are then one: no two may define the same name.
function(gnomon_unity target batch)
  if(GNOMON_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
endfunction()

# gnomon_embed_text(VARIABLE HEADER FILES...): files of the current folder as strings that HEADER declares (embed_text.cmake);
# VARIABLE names the source to compile.
function(gnomon_embed_text variable header)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${variable}.cpp)
  set(paths ${ARGN})
  list(TRANSFORM paths PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DROOT=${CMAKE_CURRENT_SOURCE_DIR} "-DFILES=${ARGN}"
            -DHEADER=${header} -DNAMESPACE=gnomon -P ${CMAKE_SOURCE_DIR}/cmake/embed_text.cmake
    DEPENDS ${paths} ${CMAKE_SOURCE_DIR}/cmake/embed_text.cmake
    VERBATIM)
  set(${variable} ${output} PARENT_SCOPE)
endfunction()
