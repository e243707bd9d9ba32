# gnomon_library(NAME LINKS ... SOURCES ...): one static library for the current folder.
#
# Headers are included as "<folder>/<file>.h". Each library publishes an include directory that holds
# one link, named after its folder, to that folder, so an include of a layer that is not linked does
# not resolve: the direction of the layers is enforced by the build. Installed, all of them stand below include/gnomon,
# and gnomon_shadow is gnomon::shadow.

# -ffp-contract=off: the shared mathematics must give the same bits in C++ and in the shaders.
add_library(gnomon_options INTERFACE)
set(warnings -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-float-conversion
    -Wno-missing-field-initializers -Werror)
target_compile_options(gnomon_options INTERFACE $<BUILD_INTERFACE:${warnings}> -ffp-contract=off)
target_compile_definitions(gnomon_options INTERFACE
  GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_FORCE_XYZW_ONLY GLM_FORCE_EXPLICIT_CTOR GLM_ENABLE_EXPERIMENTAL)
if(GNOMON_SANITIZE)
  target_compile_options(gnomon_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(gnomon_options INTERFACE -fsanitize=address,undefined)
endif()

# For find_package(Gnomon).
function(gnomon_install name)
  string(REPLACE gnomon_ "" export_name ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${export_name})
  install(TARGETS ${name} EXPORT GnomonTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/gnomon)
endfunction()
gnomon_install(gnomon_options)

function(gnomon_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  get_filename_component(folder ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set(include_dir ${CMAKE_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${include_dir})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${include_dir}/${folder} SYMBOLIC)
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
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gnomon/${folder}
          FILES_MATCHING PATTERN "*.h")
endfunction()
