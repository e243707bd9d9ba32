#include "view/view_controls.h"

#include "base/error.h"
#include "base/file.h"
#include "lab/compare/render_picture.h"
#include "lab/core/maps.h"
#include "scene/generate.h"
#include "tests/base/temporary_folder.h"
#include "view/file_check.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

ViewState stateOf(const std::string& scene) {
  CompareOptions options;
  options.maps = parseMaps("cube");
  options.biases = {&findBias("witness")};
  SetupOptions setup;
  setup.scene = scene;
  return initialState(setup, options);
}

std::shared_ptr<const TracedScene> opened(const ViewState& state) {
  return std::make_shared<const TracedScene>(openScene(state.setup));
}

void set(ViewState& state, const std::vector<Control>& controls, const std::string& name, const std::string& value) {
  findControl(controls, name).set(state, value);
}

// What is declared anywhere can be set here: nothing is listed twice.
TEST(ViewControls, AllThatIsDeclaredHasAControl) {
  const std::vector<Control> controls = viewControls(nullptr);
  std::set<std::string> names;
  for (const Control& control : controls) EXPECT_TRUE(names.insert(control.name).second) << control.name;
  for (const std::string side : {"a.", "b."}) {
    for (const MapOption* option : allMapOptions()) EXPECT_TRUE(names.contains(side + option->flag().substr(2)));
    for (const BiasMethod& method : biasMethods())
      for (const Knob& knob : method.knobs) EXPECT_TRUE(names.contains(side + knobFlag(method.name, knob).substr(2)));
    for (const Filter& filter : filters())
      for (const Knob& knob : filter.knobs) EXPECT_TRUE(names.contains(side + knobFlag(filter.name, knob).substr(2)));
    for (const BiasChoice* choice : biasChoices()) EXPECT_TRUE(names.contains(side + choice->flag().substr(2)));
    const auto offers = [&](const std::string& name, const auto& list, const auto& nameOf) {
      const std::vector<std::string>& choices = findControl(controls, side + name).choices;
      for (const auto& one : list) EXPECT_NE(std::ranges::find(choices, nameOf(one)), choices.end()) << nameOf(one);
    };
    offers("map", parameterizations(), [](const Parameterization* map) { return std::string(map->name()); });
    offers("bias", biasMethods(), [](const BiasMethod& bias) { return std::string(bias.name); });
    offers("filter", filters(), [](const Filter& filter) { return std::string(filter.name); });
    offers("integrator", integrators(), [](const Integrator& one) { return std::string(one.name); });
    offers("show", picturesToShow(), [](const std::string& name) { return name; });
  }
  for (const Control& control : controls) {
    EXPECT_FALSE(control.sentence.empty()) << control.name;
    EXPECT_FALSE(control.label.empty()) << control.name;
  }
}

// Whatever a control says, it takes back, and is then as it was.
TEST(ViewControls, EachTakesBackWhatItSays) {
  ViewState state = stateOf("atrium");
  const auto traced = opened(state);
  for (const Control& control : viewControls(traced)) {
    const std::string before = control.get(state);
    ViewState again = state;
    control.set(again, before);
    EXPECT_EQ(control.get(again), before) << control.name;
    for (const std::string& choice : control.choices) {
      ViewState chosen = state;
      try {
        control.set(chosen, choice);
      } catch (const UsageError&) {
        continue;  // what does not go together says so
      }
      EXPECT_EQ(control.get(chosen), choice) << control.name;
    }
  }
}

TEST(ViewControls, AStateIsSavedWhole) {
  ViewState state = stateOf("atrium");
  const auto traced = opened(state);
  const std::vector<Control> controls = viewControls(traced);
  set(state, controls, "light.x", "1.25");
  set(state, controls, "camera", "eye:0,2,3,target:0,1,0,fov:50");
  set(state, controls, "split", "on");
  set(state, controls, "split-at", "0.375");
  set(state, controls, "b.map", "paraboloid");
  set(state, controls, "b.map-size", "512");
  set(state, controls, "b.bias", "constant");
  set(state, controls, "b.constant-offset", "0.01");
  set(state, controls, "a.filter", "jitter4x4");
  set(state, controls, "a.jitter4x4-width", "3");
  set(state, controls, "fog", "on");
  set(state, controls, "fog.g", "0.5");
  set(state, controls, "fog.density-at", "1,2,3");
  const std::string saved = sessionJson(state);
  const ViewState read = readSession("s", saved, stateOf("lshape"));
  EXPECT_EQ(sessionJson(read), saved);
  for (int side = 0; side < kSideCount; ++side)
    EXPECT_EQ(pictureCommand(read, side, 64, 48, "p.png"), pictureCommand(state, side, 64, 48, "p.png"));
  EXPECT_NE(sessionJson(stateOf("lshape")), saved);
}

TEST(ViewControls, BrokenSessionsAreToldInOneLine) {
  const ViewState state = stateOf("atrium");
  for (const auto& [text, what] :
       {std::pair{"{", "is no JSON"}, std::pair{"[]", "is no session"}, std::pair{"{\"a\": 1}", "is no session"},
        std::pair{"{\"gnomon_view\": 2}", "another version"},
        std::pair{"{\"gnomon_view\": 1, \"a.bias\": 3}", "no text"},
        std::pair{"{\"gnomon_view\": 1, \"a.bais\": \"none\"}", "did you mean a.bias"},
        std::pair{"{\"gnomon_view\": 1, \"split-at\": \"7\"}", "outside 0..1"}}) {
    try {
      readSession("s.json", text, state);
      ADD_FAILURE() << text;
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST(ViewControls, MistakesLeaveTheStateAsItWas) {
  ViewState state = stateOf("atrium");
  const std::vector<Control> controls = viewControls(opened(state));
  const std::string before = sessionJson(state);
  for (const auto& [name, value] :
       {std::pair{"a.bias", "biass"}, std::pair{"a.map", "cubes"}, std::pair{"a.map-size", "1"},
        std::pair{"a.cascades", "many"}, std::pair{"light.x", "east"}, std::pair{"fog.g", "1"},
        std::pair{"split", "maybe"}, std::pair{"size", "0x0"}, std::pair{"direction", "0,0,0"},
        std::pair{"a.constant-offset", "-1"}}) {
    EXPECT_THROW(set(state, controls, name, value), UsageError) << name;
    EXPECT_EQ(sessionJson(state), before) << name;
  }
}

// What a file declares is a control as of any bias, is saved, and stays by its name when the file is read again.
TEST(ViewControls, ABiasFileHasItsParameters) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "mine.glsl").string();
  const auto write = [&](const std::string& knobs) {
    writeTextFile(path, "//! name: mine\n" + knobs +
                            "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {\n"
                            "  return tap.z1 > params.knobs[0];\n}\n");
  };
  write("//! knob: reach texels 0 8 2\n//! knob: rest one 0 1 0.5\n");
  ViewState state = stateOf("atrium");
  EXPECT_EQ(chosenBiasFiles(state), (std::array<uint64_t, kSideCount>{}));
  set(state, viewControls(nullptr, state), "a.bias", path);
  const uint64_t number = chosenBiasFiles(state)[0];
  EXPECT_NE(number, 0u);
  EXPECT_EQ(chosenBiasFiles(state)[1], 0u);
  std::vector<Control> controls = viewControls(nullptr, state);
  const Control& reach = findControl(controls, "a.knob.reach");
  EXPECT_EQ(reach.unit, "texels");
  EXPECT_TRUE(reach.applies(state));
  EXPECT_FALSE(reach.isGiven(state));
  EXPECT_THROW(reach.set(state, "9"), UsageError);
  reach.set(state, "3");
  set(state, controls, "a.knob.rest", "0.25");
  EXPECT_NE(pictureCommand(state, 0, 64, 48, "p.png").find("--bias-file-knob reach=3"), std::string::npos);
  const std::string saved = sessionJson(state);
  const ViewState again = readSession("s.json", saved, stateOf("corner"));
  EXPECT_EQ(sessionJson(again), saved);
  EXPECT_EQ(pictureCommand(again, 0, 64, 48, "p.png"), pictureCommand(state, 0, 64, 48, "p.png"));

  write("//! knob: other one 0 1 0.5\n//! knob: reach texels 0 8 2\n");  // `rest` is gone
  set(state, controls, "a.bias", path);
  EXPECT_NE(chosenBiasFiles(state)[0], number);
  controls = viewControls(nullptr, state);
  EXPECT_EQ(findControl(controls, "a.knob.reach").get(state), "3");
  EXPECT_EQ(findControl(controls, "a.knob.other").get(state), "0.5");
  EXPECT_THROW(findControl(controls, "a.knob.rest"), UsageError);
  EXPECT_THROW(readSession("s.json", saved, state), WorldError);
  EXPECT_EQ(findControl(controls, "a.knob.reach").get(readPastState("undo", saved, state)), "3");
  set(state, controls, "a.bias", "none");
  const std::vector<std::string>& choices = findControl(controls, "a.bias").choices;
  EXPECT_NE(std::ranges::find(choices, path), choices.end());
  EXPECT_THROW(findControl(viewControls(nullptr, state), "a.knob.reach"), UsageError);
}

// A session may be opened from another folder.
TEST(ViewControls, ASessionNamesFilesFromItsOwnFolder) {
  const test::TemporaryFolder folder;
  const std::filesystem::path session = folder.path() / "sub" / "s.json", bias = folder.path() / "mine.glsl";
  writeTextFile(bias, "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) { return true; }\n");
  ViewState state = stateOf("atrium");
  set(state, viewControls(nullptr, state), "a.bias", std::filesystem::proximate(bias).string());
  const std::string saved = sessionJson(state, session.string());
  EXPECT_NE(saved.find("\"../mine.glsl\""), std::string::npos) << saved;
  const ViewState read = readSession(session.string(), saved, stateOf("corner"));
  EXPECT_EQ(std::filesystem::weakly_canonical(findControl(viewControls(nullptr, read), "a.bias").get(read)), bias);
  EXPECT_EQ(read.setup.scene, "atrium");
}

// What a large bias asks of the compiler is asked in another thread, once.
TEST(ViewControls, ADroppedBiasIsCheckedBesideTheWindow) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "large.glsl").string();
  // 2^12 products of what is no constant.
  std::string glsl = "#define M0(x) (x * x)\n";
  for (int i = 1; i < 11; ++i) glsl += fmt::format("#define M{0}(x) M{1}(x) * M{1}(x)\n", i, i - 1);
  glsl += "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) { return M10(tap.z1) > 0.5; }\n";
  writeTextFile(file, glsl);
  EXPECT_TRUE(FileCheck::isFor(file));
  const ViewState state = stateOf("corner");
  const auto wait = [](const FileCheck& check) {
    while (!check.isDone()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  const FileCheck check(file, state);
  wait(check);
  EXPECT_NO_THROW(check.rethrow());
  // A pipe is read as long as nobody has written into it.
  const std::string session = (folder.path() / "s.json").string();
  writeTextFile(folder.path() / "nonsense.glsl", "nonsense\n");
  ASSERT_EQ(::mkfifo(session.c_str(), 0600), 0);
  const FileCheck broken(session, state);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(broken.isDone());
  std::ofstream(session) << R"({"gnomon_view": 1, "a.bias": "nonsense.glsl"})";
  wait(broken);
  EXPECT_THROW(broken.rethrow(), WorldError);
}

// Which would be waited for: nobody may ever write into it.
TEST(ViewControls, NoPipeIsRead) {
  const test::TemporaryFolder folder;
  ViewState state = stateOf("corner");
  for (const auto& [control, name] : {std::pair{"scene", "p.gltf"}, std::pair{"a.bias", "p.glsl"}}) {
    const std::string pipe = (folder.path() / name).string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THROW(set(state, viewControls(nullptr, state), control, pipe), UsageError) << pipe;
  }
}

// Nothing is a number of its own.
TEST(ViewControls, ScatteringIsTheScenesUnlessItIsGiven) {
  ViewState state = stateOf("atrium");
  const std::vector<Control> controls = viewControls(nullptr, state);
  state.fog.on = true;
  EXPECT_EQ(findControl(controls, "fog.sigma-s").get(state), "");
  EXPECT_EQ(pictureCommand(state, 0, 64, 48, "p.png").find("--sigma-s"), std::string::npos);
  set(state, controls, "fog.sigma-s", "0");
  EXPECT_NE(pictureCommand(state, 0, 64, 48, "p.png").find("--sigma-s 0"), std::string::npos);
}

// What means nothing on a volume is refused there, in whatever order it is set.
TEST(ViewControls, AVolumeTakesNoFilter) {
  ViewState state = stateOf("atrium");
  const std::vector<Control> controls = viewControls(opened(state));
  set(state, controls, "a.filter", "bilinear");
  set(state, controls, "a.map", "vsv");
  EXPECT_EQ(findControl(controls, "a.filter").get(state), "none");
  EXPECT_THROW(set(state, controls, "a.filter", "bilinear"), UsageError);
  set(state, controls, "a.filter", "none");
  EXPECT_THROW(set(state, controls, "a.bias", "witness"), UsageError);
}

TEST(ViewControls, CommandsNameWhatDiffers) {
  ViewState state = stateOf("atrium");
  const auto traced = opened(state);
  const std::vector<Control> controls = viewControls(traced);
  EXPECT_EQ(pictureCommand(state, 0, 64, 48, "p.png"),
            "gnomon render atrium --size 64x48 --maps cube --biases witness -o p.png");
  set(state, controls, "a.show", "labels");
  set(state, controls, "a.bias", "constant");
  set(state, controls, "a.constant-offset", "0.5");
  EXPECT_EQ(
      pictureCommand(state, 0, 64, 64, "p.png"),
      "gnomon render atrium --size 64 --maps cube --biases constant --constant-offset 0.5 --show labels -o p.png");
  set(state, controls, "fog", "on");
  set(state, controls, "fog.sigma-s", "0.2");
  set(state, controls, "a.integrator", "march");
  EXPECT_EQ(pictureCommand(state, 0, 64, 64, "p.png"),
            "gnomon fog atrium --size 64 --sigma-s 0.2 --integrators march --steps 64 -o p.png");
  set(state, controls, "a.show", "medium");
  EXPECT_EQ(pictureCommand(state, 0, 64, 64, "p.png"),
            "gnomon fog atrium --size 64 --sigma-s 0.2 --integrators march --steps 64 --show medium -o p.png");
}

// A light that is moved keeps its name and power; a camera stands where it was put.
TEST(ViewControls, WhatIsMovedIsFoundThere) {
  ViewState state = stateOf("atrium");
  const auto traced = opened(state);
  const Light before = lightOf(state, *traced);
  moveLight(state, *traced, {1.5, 2.25, -3.0});
  const Light after = lightOf(state, *traced);
  EXPECT_EQ(after.positionW, glm::vec3(1.5f, 2.25f, -3.0f));
  EXPECT_EQ(after.intensity, before.intensity);
  EXPECT_EQ(state.setup.light, before.name + "@1.5,2.25,-3");
  placeCamera(state, *traced, {1, 2, 3}, {0, 1, 0}, 45.0);
  const Camera camera = chooseCamera(state.setup, traced->tracer);
  EXPECT_EQ(glm::vec3(camera.worldFromEye[3]), glm::vec3(1, 2, 3));
  EXPECT_NEAR(glm::degrees(camera.yFovRad), 45.0f, 1e-4f);
}

}  // namespace
}  // namespace gnomon
