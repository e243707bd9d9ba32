#include "gpu/shader_compiler.h"

#include "base/check.h"
#include "base/error.h"
#include "base/file.h"
#include "gpu/embedded_shaders.h"
#include "gpu/spirv_cache.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

namespace gnomon::gpu {

namespace fs = std::filesystem;

namespace {

// Every entry file gets this, so that it begins with a comment and not with a list of extensions.
// `texelFetch` on a texture without sampler needs the third, gl_ViewIndex the fourth.
constexpr const char* kPreamble =
    "#version 460\n"
    "#extension GL_GOOGLE_cpp_style_line_directive : require\n"
    "#extension GL_EXT_scalar_block_layout : require\n"
    "#extension GL_EXT_samplerless_texture_functions : require\n"
    "#extension GL_EXT_multiview : require\n"
    "#extension GL_EXT_control_flow_attributes : require\n";

// glslang reports follow-up errors by the dozen; the first ones name the cause.
constexpr size_t kMessageCount = 3;

// What shaders include of the system's headers stands beside the built-in shaders only.
constexpr std::string_view kSystemFolder = "nanovdb/";

std::mutex shaderDirectoryMutex;
fs::path chosenShaderDirectory;  // empty: the embedded sources

std::atomic<int> compiledCount{0};
std::atomic<int> foundCount{0};

struct Stage {
  const char* suffix;
  EShLanguage language;
};

const Stage kStages[] = {
    {".vert.glsl", EShLangVertex},      {".frag.glsl", EShLangFragment},       {".comp.glsl", EShLangCompute},
    {".tesc.glsl", EShLangTessControl}, {".tese.glsl", EShLangTessEvaluation}, {".geom.glsl", EShLangGeometry},
};

EShLanguage stageOf(const std::string& path) {
  for (const Stage& stage : kStages)
    if (path.ends_with(stage.suffix)) return stage.language;
  throw fileError(path, "its name does not say which shader stage it is",
                  "end it in .vert.glsl, .frag.glsl, .comp.glsl, .tesc.glsl, .tese.glsl or .geom.glsl");
}

// Absent where there is no such file.
std::optional<std::string> findSource(const ShaderSource& source, const std::string& path) {
  if (const auto found = source.overrides.find(path); found != source.overrides.end()) return found->second;
  if (const fs::path folder = shaderDirectory(); !folder.empty()) {
    std::error_code failure;
    if (fs::is_regular_file(folder / path, failure)) return readFile(folder / path);
    if (!path.starts_with(kSystemFolder)) return std::nullopt;
  }
  for (size_t i = 0; i < kEmbeddedShaderCount; ++i)
    if (path == kEmbeddedShaders[i].path) return kEmbeddedShaders[i].text;
  return std::nullopt;
}

// The file that a line includes in quotes; empty for other lines. <...> is C++'s, and left to the preprocessor to skip.
std::string_view includedFile(std::string_view line) {
  const auto skipSpace = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  skipSpace();
  if (!line.starts_with('#')) return {};
  line.remove_prefix(1);
  skipSpace();
  if (!line.starts_with("include")) return {};
  line.remove_prefix(7);
  skipSpace();
  if (!line.starts_with('"')) return {};
  const size_t end = line.find('"', 1);
  return end == std::string_view::npos ? std::string_view{} : line.substr(1, end - 1);
}

class Expander {
 public:
  explicit Expander(const ShaderSource& source) : source_(source) {}

  std::string expand() {
    text_ = kPreamble;
    append(source_.path, "");
    return std::move(text_);
  }

 private:
  // `from`: the including line as "path:line", for the message.
  void append(const std::string& path, const std::string& from) {
    // Once only: a file that includes itself, or that two others include, ends here.
    if (!seen_.insert(path).second) return;
    const std::optional<std::string> content = findSource(source_, path);
    if (!content)
      throw WorldError(fmt::format("{}: there is no shader file '{}'{}", from.empty() ? path : from, path, where()));
    text_ += fmt::format("#line 1 \"{}\"\n", path);
    int lineNumber = 1;
    for (size_t begin = 0; begin < content->size(); ++lineNumber) {
      const size_t end = std::min(content->find('\n', begin), content->size());
      const std::string_view line = std::string_view(*content).substr(begin, end - begin);
      begin = end + 1;
      const std::string included(includedFile(line));
      if (included.empty()) {
        text_ += line;
        text_ += '\n';
        continue;
      }
      append(included, fmt::format("{}:{}", path, lineNumber));
      text_ += fmt::format("#line {} \"{}\"\n", lineNumber + 1, path);
    }
  }

  static std::string where() {
    const fs::path folder = shaderDirectory();
    return folder.empty() ? " among the built-in shaders; check the name"
                          : fmt::format(" in {}; check the name and --shader-dir", folder.string());
  }

  const ShaderSource& source_;
  std::set<std::string> seen_;
  std::string text_;
};

// From glslang's "ERROR: path:12: 'x' : undeclared identifier" to "path:12: 'x' : undeclared identifier".
std::string errorLines(const std::string& path, const char* log) {
  constexpr std::string_view kError = "ERROR: ";
  std::vector<std::string> messages;
  std::string_view rest = log;
  while (!rest.empty() && messages.size() < kMessageCount) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!line.starts_with(kError)) continue;
    line.remove_prefix(kError.size());
    if (line.find(" compilation errors.") != std::string_view::npos) continue;
    // glslang stops at the first error that is one of syntax or type, within the #ifdefs that it stands in.
    if (line.find("'' : compilation terminated") != std::string_view::npos) continue;
    if (!messages.empty() && line.find("'' : missing #endif") != std::string_view::npos) continue;
    // Of functions that call each other, the next line has the names.
    constexpr std::string_view kLink = "Linking ";
    const bool isCut = line.ends_with(':') && !rest.empty();
    const std::string_view more = isCut ? rest.substr(std::min(rest.find_first_not_of(" \t\n"), rest.size())) : "";
    messages.push_back((line.starts_with(kLink) ? path + ": " : "") + std::string(line) + (isCut ? " " : "") +
                       std::string(more.substr(0, more.find('\n'))));
  }
  if (messages.empty()) return fmt::format("{}: glslang gave no message", path);
  return fmt::format("{}", fmt::join(messages, "; "));
}

std::vector<uint32_t> compileWithGlslang(const std::string& path, EShLanguage stage, const std::string& text) {
  static std::once_flag initialized;
  std::call_once(initialized, [] { glslang::InitializeProcess(); });

  glslang::TShader shader(stage);
  const char* strings[] = {text.c_str()};
  const char* names[] = {path.c_str()};
  shader.setStringsWithLengthsAndNames(strings, nullptr, names, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  const auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  if (!shader.parse(GetDefaultResources(), 460, false, rules)) throw WorldError(errorLines(path, shader.getInfoLog()));
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(rules)) throw WorldError(errorLines(path, program.getInfoLog()));

  glslang::SpvOptions options;
  options.disableOptimizer = true;  // the driver optimizes; and what is exact in the source stays so
  options.generateDebugInfo = false;
  std::vector<uint32_t> spirv;
  glslang::GlslangToSpv(*program.getIntermediate(stage), spirv, &options);
  GNOMON_CHECK(!spirv.empty());
  return spirv;
}

}  // namespace

void setShaderDirectory(const fs::path& folder) {
  std::error_code failure;
  if (!fs::is_directory(folder, failure))
    throw fileError(folder.string(), "is not a folder of shaders",
                    "give the path of a copy of Gnomon's shaders folder");
  std::lock_guard lock(shaderDirectoryMutex);
  chosenShaderDirectory = folder;
}

fs::path shaderDirectory() {
  std::lock_guard lock(shaderDirectoryMutex);
  return chosenShaderDirectory;
}

fs::path cacheDirectory() {
  if (const char* own = std::getenv("GNOMON_CACHE_DIR")) return own;
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg && *xdg) return fs::path(xdg) / "gnomon";
  const char* home = std::getenv("HOME");
  if (home && *home) return fs::path(home) / ".cache" / "gnomon";
  return {};
}

std::string expandShader(const ShaderSource& source) {
  return Expander(source).expand();
}

std::vector<uint32_t> compileShader(const ShaderSource& source) {
  const EShLanguage stage = stageOf(source.path);
  const std::string text = expandShader(source);
  const glslang::Version version = glslang::GetVersion();
  const Hash128 key = hashText(fmt::format("stage {} glslang {}.{}.{}{} Vulkan 1.3\n{}", static_cast<int>(stage),
                                           version.major, version.minor, version.patch, version.flavor, text));
  if (std::optional<std::vector<uint32_t>> cached = readCachedSpirv(key)) {
    ++foundCount;
    return std::move(*cached);
  }
  std::vector<uint32_t> spirv = compileWithGlslang(source.path, stage, text);
  ++compiledCount;
  writeCachedSpirv(key, spirv);
  return spirv;
}

ShaderCacheCounts shaderCacheCounts() {
  return {.compiled = compiledCount, .found = foundCount};
}

}  // namespace gnomon::gpu
