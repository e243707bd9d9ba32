// SPIR-V on disk: found again, never trusted when damaged, never in the way.
#include "gpu/spirv_cache.h"

#include "tests/gpu_fixture.h"

#include <fmt/format.h>

namespace gnomon::gpu {
namespace {

namespace fs = std::filesystem;

class SpirvCacheTest : public ::testing::Test {
 protected:
  SpirvCacheTest() { ::setenv("GNOMON_CACHE_DIR", folder_.path().c_str(), 1); }

  static ShaderSource source(int value) {
    return inlineShader("t/a.comp.glsl",
                        fmt::format("layout(local_size_x = 1) in;\nlayout(scalar, binding = 0) buffer B {{ int v; }};\n"
                                    "void main() {{ v = {}; }}\n",
                                    value));
  }

  // Compiles and tells what was counted meanwhile.
  static ShaderCacheCounts compile(const ShaderSource& source, std::vector<uint32_t>* spirv = nullptr) {
    const ShaderCacheCounts before = shaderCacheCounts();
    const std::vector<uint32_t> words = compileShader(source);
    if (spirv) *spirv = words;
    const ShaderCacheCounts after = shaderCacheCounts();
    return {after.compiled - before.compiled, after.found - before.found};
  }

  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      if (entry.is_regular_file()) found.push_back(entry.path());
    return found;
  }

  TemporaryFolder folder_;
};

TEST_F(SpirvCacheTest, ColdCompilesAndWarmFinds) {
  std::vector<uint32_t> cold, warm;
  const ShaderCacheCounts first = compile(source(1), &cold);
  EXPECT_EQ(first.compiled, 1);
  EXPECT_EQ(first.found, 0);
  const ShaderCacheCounts second = compile(source(1), &warm);
  EXPECT_EQ(second.compiled, 0);
  EXPECT_EQ(second.found, 1);
  EXPECT_EQ(cold, warm);
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(SpirvCacheTest, AnyChangeOfSourceStageOrIncludeCompilesAgain) {
  compile(source(1));
  EXPECT_EQ(compile(source(2)).compiled, 1);
  ShaderSource with =
      inlineShader("t/b.comp.glsl", "#include \"c.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n");
  with.overrides["c.glsl"] = "const int kC = 1;\n";
  EXPECT_EQ(compile(with).compiled, 1);
  with.overrides["c.glsl"] = "const int kC = 2;\n";
  EXPECT_EQ(compile(with).compiled, 1);
  const char* text = "void main() {}\n";
  EXPECT_EQ(compile(inlineShader("t/s.vert.glsl", text)).compiled, 1);
  EXPECT_EQ(compile(inlineShader("t/s.frag.glsl", text)).compiled, 1);
}

TEST_F(SpirvCacheTest, AFileCutShortAtAnyLengthIsCompiledAgain) {
  std::vector<uint32_t> good, again;
  compile(source(1), &good);
  const fs::path file = files().at(0);
  const std::string whole = readFile(file);
  for (size_t length = 0; length < whole.size(); length += 7) {
    writeTextFile(file, whole.substr(0, length));
    EXPECT_EQ(compile(source(1), &again).compiled, 1) << length;
    ASSERT_EQ(again, good) << length;
    ASSERT_EQ(readFile(file), whole) << length;
  }
  writeTextFile(file, whole + "abcd");
  EXPECT_EQ(compile(source(1)).compiled, 1);
}

TEST_F(SpirvCacheTest, AChangedByteAnywhereIsNoticed) {
  compile(source(1));
  const fs::path file = files().at(0);
  const std::string whole = readFile(file);
  for (size_t at = 0; at < whole.size(); at += 3) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
    writeTextFile(file, damaged);
    ASSERT_EQ(compile(source(1)).compiled, 1) << at;
  }
}

TEST_F(SpirvCacheTest, ACacheThatCannotBeWrittenIsPassedOver) {
  ::setenv("GNOMON_CACHE_DIR", "/dev/null/nowhere", 1);
  EXPECT_EQ(compile(source(1)).compiled, 1);
  EXPECT_EQ(compile(source(1)).compiled, 1);
  ::setenv("GNOMON_CACHE_DIR", "", 1);
  EXPECT_EQ(compile(source(1)).compiled, 1);
  EXPECT_TRUE(files().empty());
}

TEST_F(SpirvCacheTest, TheFolderFollowsTheEnvironment) {
  EXPECT_EQ(cacheDirectory(), folder_.path());
  ::unsetenv("GNOMON_CACHE_DIR");
  ::setenv("XDG_CACHE_HOME", "/x", 1);
  EXPECT_EQ(cacheDirectory(), fs::path("/x/gnomon"));
  ::unsetenv("XDG_CACHE_HOME");
  ::setenv("HOME", "/h", 1);
  EXPECT_EQ(cacheDirectory(), fs::path("/h/.cache/gnomon"));
  ::unsetenv("HOME");
  EXPECT_TRUE(cacheDirectory().empty());
}

// Published values of FNV-1a with 128 bits.
TEST(SpirvCache, TheHashIsFnv1a) {
  EXPECT_EQ(hashText(""), (Hash128{0x6c62272e07bb0142, 0x62b821756295c58d}));
  EXPECT_EQ(hashText("a"), (Hash128{0xd228cb696f1a8caf, 0x78912b704e4a8964}));
  EXPECT_EQ(hashText("foobar"), (Hash128{0x343e1662793c64bf, 0x6f0d3597ba446f18}));
}

}  // namespace
}  // namespace gnomon::gpu
