#include "tests/lab/export/compile_export.h"

#include "base/file.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"
#include "tests/lab/export/what_to_export.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cstdlib>

namespace gnomon::test {

using code::Language;

std::string calls(const std::string& text, const char* pixel, const char* place, const char* normal) {
  const size_t at = text.find("GnomonReceiver gnomonReceiverAt(");
  const std::string head = text.substr(at, text.find(')', at) - at);
  std::string receiver = std::string("gnomonReceiverAt(frame, ") + place;
  if (mentions(head, "normalW")) receiver += std::string(", ") + normal;
  if (mentions(head, " id")) receiver += ", triangleId";
  const size_t from = text.find("float gnomonVisibility(");
  const std::string asked = text.substr(from, text.find(')', from) - from);
  return std::string("gnomonVisibility(") + (mentions(asked, " map") ? "map, " : "") + receiver + ")" +
         (mentions(asked, " pixel") ? std::string(", ") + pixel : "") + ")";
}

std::string compiled(Language language, const std::string& text) {
  const char* const kPixel = language == Language::Hlsl ? "int2(3, 4)" : "ivec2(3, 4)";
  const bool hasMap = mentions(text, "struct GnomonShadowMap");
  const std::string map = hasMap ? "GnomonShadowMap map; " : "";
  const std::string call = calls(text, kPixel, "p", "p");
  std::string source;
  if (language == Language::Glsl)
    source =
        "#version 430\n" + text +
        "layout(location = 0) in vec3 p;\nlayout(location = 0) out vec4 colour;\nlayout(binding = 9) uniform U { " +
        map +
        "GnomonLightFrame frame; };\n"
        "void main() {\n  uint triangleId = 1u;\n  colour = vec4(" +
        call + ");\n}\n";
  if (language == Language::GlslEs)
    source = "#version 300 es\n" + text + "in vec3 p;\nout vec4 colour;\n" +
             std::string(hasMap ? "uniform GnomonShadowMap map;\n" : "") +
             "uniform GnomonLightFrame frame;\n"
             "void main() {\n  uint triangleId = 1u;\n  colour = vec4(" +
             call + ");\n}\n";
  if (language == Language::Hlsl)
    source = text + "cbuffer U : register(b0) { " + map +
             "GnomonLightFrame frame; };\n"
             "float main(float3 p : TEXCOORD0) : SV_Target {\n  uint triangleId = 1u;\n  return " +
             call + ";\n}\n";
  glslang::InitializeProcess();
  glslang::TShader shader(EShLangFragment);
  const char* strings[] = {source.c_str()};
  shader.setStrings(strings, 1);
  shader.setEntryPoint("main");
  auto messages = EShMsgDefault;
  if (language == Language::Glsl) {
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangFragment, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
    messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  } else if (language == Language::Hlsl) {
    shader.setEnvInput(glslang::EShSourceHlsl, EShLangFragment, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
    messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgReadHlsl);
  }
  if (!shader.parse(GetDefaultResources(), language == Language::GlslEs ? 300 : 430, false, messages))
    return shader.getInfoLog();
  glslang::TProgram program;
  program.addShader(&shader);
  return program.link(messages) ? "" : program.getInfoLog();
}

std::string metalErrors(const std::string& text) {
  const TemporaryFolder folder;
  writeTextFile(folder.path() / "all.cpp", text);
  const std::string command =
      fmt::format("{} -std=c++14 -fsyntax-only -w -I {}/export/metal {} 2>{}", GNOMON_CXX, inSource(GNOMON_TEST_FOLDER),
                  (folder.path() / "all.cpp").string(), (folder.path() / "errors").string());
  if (std::system(command.c_str()) == 0) return "";
  return "failed: " + readFile(folder.path() / "errors").substr(0, 2000);
}

}  // namespace gnomon::test
