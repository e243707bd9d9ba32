# Writes OUTPUT: a table of {path, text} of the shader FILES below ROOT.
# Raw string literals hold at most 65,536 characters, which no shader here comes near.
get_filename_component(header ${ROOT}/../src/gpu/embedded_shaders.h ABSOLUTE)
set(text "// Made by cmake/embed_shaders.cmake from shaders/.\n#include \"${header}\"\n\nnamespace gnomon::gpu {\n\n")
string(APPEND text "const EmbeddedShader kEmbeddedShaders[] = {\n")
set(count 0)
foreach(file IN LISTS FILES)
  file(READ ${ROOT}/${file} content)
  string(APPEND text "    {\"${file}\", R\"GNOMON(${content})GNOMON\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
string(APPEND text "};\nconst size_t kEmbeddedShaderCount = ${count};\n\n}  // namespace gnomon::gpu\n")
file(WRITE ${OUTPUT} "${text}")
