// docs/results.schema.json holds for what the program writes, and for nothing else.
#include "cli_fixture.h"

#include "tests/base/places.h"

#include <functional>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

using nlohmann::json;
using test::CliTest;

class SchemaTest : public CliTest {
 protected:
  void SetUp() override {
    writeTextFile(folder_ / "check.py", R"(
import json, sys
import jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
data = json.load(open(sys.argv[2]))
kind = schema['oneOf'][1 if data.get('media') else 0]
errors = list(jsonschema.Draft202012Validator(kind).iter_errors(data))
for error in errors[:5]:
    print('/'.join(map(str, error.absolute_path)), error.message[:200])
errors += [] if jsonschema.Draft202012Validator(schema).is_valid(data) else [1]
sys.exit(1 if errors else 0)
)");
    if (std::system("python3 -c 'import jsonschema' 2>/dev/null") != 0)
      GTEST_SKIP() << "skipped: no python3-jsonschema here (tools/setup installs it)";
  }

  bool isValid(const std::filesystem::path& file) const {
    const std::string command = "python3 '" + (folder_ / "check.py").string() + "' '" +
                                test::inSource("docs/results.schema.json") + "' '" + file.string() + "' >'" +
                                (folder_ / "errors").string() + "' 2>&1";
    const bool valid = std::system(command.c_str()) == 0;
    errors_ = readFile(folder_ / "errors");
    return valid;
  }

  mutable std::string errors_;
};

TEST_F(SchemaTest, HoldsForEveryKindOfRun) {
  for (const char* arguments :
       {"compare atrium --light all --maps cube,vsv --vsv-size 64x64x128 --biases none,constant,dual,witness --filters "
        "none,bilinear --tune --until-error 50% --until-map-size 64 --size 48 --map-size 32 --repeats 1 -o @/out",
        "compare corner --maps directional --biases none --size 24 --map-size 24 --repeats 1",
        "fog grate --truth --bound 0.05 --steps 8,16 --size 24 --vsv-size 64x64x128 --map-size 32 --repeats 1 --frames "
        "2 "
        "--move orbit:y,20 -o @/fog",
        "fog grate --size 24 --vsv-size 64x64x128 --map-size 32 --repeats 1 --steps 8"}) {
    const test::Result result = run(std::string(arguments) + " --json @/r.json");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_TRUE(isValid(folder_ / "r.json")) << arguments << "\n" << errors_;
  }
}

TEST_F(SchemaTest, RefusesWhatIsNoneOfItsFields) {
  ASSERT_EQ(
      run("compare corner --maps cube --biases none --size 24 --map-size 24 --repeats 1 --json @/r.json").exitCode, 0);
  const json good = json::parse(readFile(folder_ / "r.json"));
  const auto isValidWith = [&](const std::function<void(json&)>& change) {
    json bad = good;
    change(bad);
    writeTextFile(folder_ / "bad.json", bad.dump());
    return isValid(folder_ / "bad.json");
  };
  EXPECT_TRUE(isValidWith([](json&) {})) << errors_;
  EXPECT_FALSE(isValidWith([](json& j) { j["rows"][0]["acne"] = -1; }));
  EXPECT_FALSE(isValidWith([](json& j) { j["rows"][0]["new"] = 1; }));
  EXPECT_FALSE(isValidWith([](json& j) { j["rows"][0].erase("acne"); }));
  EXPECT_FALSE(isValidWith([](json& j) { j["camera"]["eye"] = json::array({1, 2}); }));
  EXPECT_FALSE(isValidWith([](json& j) { j["schema"] = 3; }));
  EXPECT_FALSE(isValidWith([](json& j) { j["rows"][0]["build_ms"] = nullptr; }));
}

}  // namespace
}  // namespace gnomon
