// Sources, includes, and errors that name their file and line.
#include "gpu/shader_compiler.h"

#include "base/error.h"
#include "tests/gpu_fixture.h"

#include <thread>

#include <fmt/format.h>

namespace gnomon::gpu {
namespace {

constexpr const char* kEmptyMain = "layout(local_size_x = 1) in;\nvoid main() {}\n";

std::string refusal(const ShaderSource& source) {
  try {
    compileShader(source);
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

size_t countOf(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(ShaderCompiler, EmbeddedFilesAreFoundAndExpandedOnce) {
  const ShaderSource source =
      inlineShader("t/a.comp.glsl", "#include \"shared/texture.glsl\"\n#include \"shared/lang.glsl\"\n" +
                                        std::string("#include \"shared/texture.glsl\"\n") + kEmptyMain);
  const std::string text = expandShader(source);
  EXPECT_EQ(countOf(text, "struct TextureTaps {"), 1u);
  EXPECT_EQ(countOf(text, "#define GNOMON_LANG_GLSL"), 1u);
  EXPECT_EQ(countOf(text, "#include \""), 0u);
  EXPECT_FALSE(compileShader(source).empty());
}

TEST(ShaderCompiler, IncludeCyclesEnd) {
  ShaderSource source = inlineShader("t/a.comp.glsl", std::string("#include \"b.glsl\"\n") + kEmptyMain);
  source.overrides["b.glsl"] = "#include \"c.glsl\"\nconst int kB = 1;\n";
  source.overrides["c.glsl"] = "  #  include \"b.glsl\"\n#include \"t/a.comp.glsl\"\nconst int kC = 2;\n";
  EXPECT_EQ(countOf(expandShader(source), "const int kB"), 1u);
  EXPECT_FALSE(compileShader(source).empty());
}

TEST(ShaderCompiler, AnErrorNamesItsFileAndLine) {
  const ShaderSource source =
      inlineShader("t/bad.comp.glsl", "// one\nlayout(local_size_x = 1) in;\nvoid main() {\n  int x = y;\n}\n");
  EXPECT_TRUE(refusal(source).starts_with("t/bad.comp.glsl:4: 'y' : undeclared identifier")) << refusal(source);
}

TEST(ShaderCompiler, AnErrorInAnIncludedFileNamesThatFile) {
  ShaderSource source = inlineShader(
      "t/a.comp.glsl", "#include \"shared/texture.glsl\"\n#include \"user/bias.glsl\"\n" + std::string(kEmptyMain));
  source.overrides["user/bias.glsl"] = "\n#include \"shared/lang.glsl\"\nfloat bias() { return 1.0 +; }\n";
  EXPECT_TRUE(refusal(source).starts_with("user/bias.glsl:3: ")) << refusal(source);
}

TEST(ShaderCompiler, AnErrorAfterAnIncludeKeepsItsLine) {
  const ShaderSource source = inlineShader(
      "t/a.comp.glsl", "#include \"shared/texture.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() { oops(); }\n");
  EXPECT_TRUE(refusal(source).starts_with("t/a.comp.glsl:3: ")) << refusal(source);
}

TEST(ShaderCompiler, ManyErrorsAreCutToTheFirst) {
  std::string text = "layout(local_size_x = 1) in;\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("int f{}() {{ return oops{}; }}\n", i, i);
  const std::string message = refusal(inlineShader("t/many.comp.glsl", text + "void main() {}\n"));
  EXPECT_LE(countOf(message, "t/many.comp.glsl:"), 3u) << message;
  EXPECT_EQ(countOf(message, "\n"), 0u) << message;
  EXPECT_EQ(countOf(message, "compilation errors"), 0u) << message;
}

TEST(ShaderCompiler, AMissingIncludeNamesWhoAsksForIt) {
  const std::string message =
      refusal(inlineShader("t/a.comp.glsl", std::string("//\n#include \"shared/nothing.glsl\"\n") + kEmptyMain));
  EXPECT_TRUE(message.starts_with("t/a.comp.glsl:2: ")) << message;
  EXPECT_NE(message.find("'shared/nothing.glsl'"), std::string::npos) << message;
}

TEST(ShaderCompiler, AMissingShaderAndAnUnknownStageAreRefused) {
  EXPECT_NE(refusal({.path = "t/nothing.comp.glsl", .overrides = {}}).find("t/nothing.comp.glsl"), std::string::npos);
  EXPECT_NE(refusal(inlineShader("t/a.glsl", kEmptyMain)).find("shader stage"), std::string::npos);
}

TEST(ShaderCompiler, AFileWithoutMainIsRefused) {
  EXPECT_FALSE(refusal(inlineShader("t/a.comp.glsl", "layout(local_size_x = 1) in;\n")).empty());
  EXPECT_FALSE(refusal(inlineShader("t/a.comp.glsl", "")).empty());
}

TEST(ShaderCompiler, WindowsLineEndsAndAMissingLastOneAreFine) {
  ShaderSource source =
      inlineShader("t/a.comp.glsl", "#include \"b.glsl\"\r\nlayout(local_size_x = 1) in;\r\nvoid main() {}");
  source.overrides["b.glsl"] = "const int kB = 1;";
  EXPECT_EQ(refusal(source), "");
}

TEST(ShaderCompiler, AnOverrideReplacesAnEmbeddedFile) {
  ShaderSource source = inlineShader("t/a.comp.glsl", std::string("#include \"shared/texture.glsl\"\n") + kEmptyMain);
  source.overrides["shared/texture.glsl"] = "// mine\n";
  const std::string text = expandShader(source);
  EXPECT_EQ(countOf(text, "// mine"), 1u);
  EXPECT_EQ(countOf(text, "TextureTaps"), 0u);
}

TEST(ShaderCompiler, AShaderFolderReplacesTheEmbeddedFiles) {
  const TemporaryFolder folder;
  writeTextFile(folder.path() / "t" / "mine.comp.glsl", kEmptyMain);
  EXPECT_THROW(setShaderDirectory(folder.path() / "nothing"), WorldError);
  setShaderDirectory(folder.path());
  EXPECT_FALSE(compileShader({.path = "t/mine.comp.glsl", .overrides = {}}).empty());
  const std::string message = refusal({.path = "shared/absent.comp.glsl", .overrides = {}});
  EXPECT_NE(message.find("--shader-dir"), std::string::npos) << message;
}

TEST(ShaderCompiler, ThreadsCompileAtOnce) {
  const TemporaryFolder cache;
  ::setenv("GNOMON_CACHE_DIR", cache.path().c_str(), 1);
  const auto text = [](int i) {
    return fmt::format("#include \"shared/texture.glsl\"\nlayout(local_size_x = {}) in;\nvoid main() {{}}\n", i + 1);
  };
  std::vector<std::vector<uint32_t>> results(16);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = t; i < 16; i += 4) results[i] = compileShader(inlineShader("t/a.comp.glsl", text(i)));
    });
  for (std::thread& thread : threads) thread.join();
  ::setenv("GNOMON_CACHE_DIR", "", 1);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(results[i], compileShader(inlineShader("t/a.comp.glsl", text(i)))) << i;
}

}  // namespace
}  // namespace gnomon::gpu
