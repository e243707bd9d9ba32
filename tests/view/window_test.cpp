// The window as a person uses it: the real program on a display of its own (Xvfb), by scripts, and by X events.

#include "base/file.h"
#include "base/image.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

struct Result {
  int exitCode = -1;
  std::string out, err;
};

class WindowTest : public ::testing::Test {
 protected:
  // In the test's folder.
  Result shell(const std::string& command) const {
    const std::string whole =
        fmt::format("cd '{}' && {{ {}; }} >stdout 2>stderr </dev/null", folder().string(), command);
    const int status = std::system(whole.c_str());
    return {.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            .out = readFile(folder() / "stdout"),
            .err = readFile(folder() / "stderr")};
  }
  // On a display of its own, 1000 x 700, whose number the server chooses.
  Result view(const std::string& arguments, const std::string& before = "") const {
    writeTextFile(folder() / "run", fmt::format(R"(rm -f display
'{}' -displayfd 3 -screen 0 1000x700x24 -nolisten tcp 3>display 2>/dev/null &
server=$!
for i in $(seq 1200); do [ -s display ] && break; sleep 0.05; done
export DISPLAY=:$(cat display)
{}
timeout 600 '{}' view {}
code=$?
kill $server $person
exit $code
)",
                                                GNOMON_XVFB, before, test::inBuild("gnomon"), arguments));
    return shell("sh run");
  }
  // With a hand that acts when the first picture is there, whose title names the scene, and presses Ctrl+Q in the end
  // until the window is gone. `acts`: shell; $x is xdotool, $id the window. Without a window manager keys go where the
  // pointer is until a window has the focus. Keys are let go at once, as a quick hand does.
  Result viewByHand(const std::string& arguments, const std::string& acts) const {
    return view(arguments, fmt::format("x='{}'\n"
                                       "( for i in $(seq 1500); do id=$($x search --onlyvisible --name Gnomon: "
                                       "2>/dev/null | head -1); [ -n \"$id\" ] && break; sleep 0.1; done\n"
                                       "$x mousemove 700 300 windowfocus --sync $id; sleep 1\n"
                                       "{}\n"
                                       "for i in $(seq 100); do $x key --delay 0 ctrl+q; sleep 1; done ) & person=$!",
                                       GNOMON_XDOTOOL, acts));
  }
  Result play(const std::string& arguments, const std::string& script) const {
    writeTextFile(folder() / "script", script);
    return view(arguments + " --window 1000x700 --script script --json times.json");
  }
  void expectSame(const std::string& a, const std::string& b) const {
    const ImageF one = readImage(folder() / a), two = readImage(folder() / b);
    ASSERT_EQ(one.width, two.width);
    ASSERT_EQ(one.height, two.height);
    EXPECT_EQ(one.values, two.values) << a << " " << b;
  }
  void expectFine(const Result& result) const { EXPECT_EQ(result.exitCode, 0) << result.err << result.out; }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
};

// What the status line says is what makes the picture, whatever was done before.
TEST_F(WindowTest, PicturesAreThoseOfTheCommandInTheStatusLine) {
  const Result played = play("atrium --size 160x120 --map-size 128",
                             "wait-refined\n"
                             "command\npicture a.png\n"
                             "drag 80 60 110 50 4\n"  // the camera
                             "wait-refined\ncommand\npicture b.png\n"
                             "set a.bias adaptive\nset a.show labels\nset light.y 2.5\n"
                             "wait-refined\ncommand\npicture c.png\n"
                             "undo\nundo\nundo\nundo\nwait-refined\npicture d.png\n"
                             "screenshot window.png\n");
  expectFine(played);
  std::vector<std::string> commands;
  for (size_t from = played.out.find("gnomon render"); from != std::string::npos;
       from = played.out.find("gnomon render", from + 1))
    commands.push_back(played.out.substr(from, played.out.find('\n', from) - from));
  ASSERT_EQ(commands.size(), 3u) << played.out;
  EXPECT_NE(commands[1].find("--camera eye:"), std::string::npos);
  EXPECT_NE(commands[2].find("--light lantern@"), std::string::npos) << commands[2];
  for (size_t i = 0; i < 3; ++i) {
    const std::string words = commands[i].substr(std::string("gnomon").size());
    expectFine(shell(fmt::format("'{}'{}", test::inBuild("gnomon"), words)));
    expectSame("picture.png", fmt::format("{}.png", "abc"[i]));
  }
  expectSame("a.png", "d.png");  // undone
  const ImageF window = readImage(folder() / "window.png");
  EXPECT_EQ(window.width, 1000);
  EXPECT_EQ(window.height, 700);
  const auto times = nlohmann::json::parse(readFile(folder() / "times.json"));
  EXPECT_GT(times["latency"]["count"].get<int>(), 3);
  EXPECT_GT(times["first_picture_ms"].get<double>(), 0.0);
}

// Beside another, with its parameters, which a session keeps.
TEST_F(WindowTest, ABiasOfOnesOwnStandsBesideAnother) {
  writeTextFile(folder() / "mine.glsl",
                "//! name: mine\n//! knob: offset metres 0 1 0.1\n"
                "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {\n"
                "  return depthTowardsLight(map, tap.slice, receiver.posL, tap.ray, params.knobs[kUserOffset]) <= "
                "tap.z1;\n}\n");
  const std::string own = "--bias-file mine.glsl --bias-file-knob offset=0.02 ";
  const Result played = play("lshape --size 96 --map-size 64 --biases mine,none --show labels " + own,
                             "wait-refined\nexpect split on\nexpect a.bias mine.glsl\nexpect b.bias none\n"
                             "set a.knob.offset 0.03\nwait-refined\ncommand\npicture a.png a\npicture b.png b\n"
                             "save s.json\nset a.bias none\nundo\nexpect a.knob.offset 0.03\n");
  expectFine(played);
  expectFine(view("--session s.json --picture again.png --frames 2 --window 1000x700"));
  expectSame("a.png", "again.png");
  const std::string render = "'" + test::inBuild("gnomon") + "' render lshape --size 96 --map-size 64 --show labels ";
  expectFine(shell(render + "--maps directional --bias-file mine.glsl --bias-file-knob 0.03 -o own.png"));
  expectSame("a.png", "own.png");
  expectFine(shell(render + "--maps directional --biases none -o none.png"));
  expectSame("b.png", "none.png");
  const Result early = play("lshape --size 64", "wait-refined\npicture b.png b\n");
  EXPECT_EQ(early.exitCode, 1);
  EXPECT_NE(early.err.find("script:2: B is not shown"), std::string::npos) << early.err;
}

// The light dragged in the picture, keys, the split, sessions, files that are broken, sizes.
TEST_F(WindowTest, ItIsUsed) {
  writeTextFile(folder() / "broken.glb", "no glTF");
  writeTextFile(folder() / "broken.json", "{");
  const Result played =
      play("lshape --size 128 --map-size 64 --biases constant",
           "wait-refined\nexpect split off\n"
           "key tab\nexpect split on\nkey 5\nexpect a.show labels\nkey shift+4\nexpect b.show difference\n"
           "key l\nexpect loupe on\nkey m\nexpect unfolded on\nmove 64 64\nwait-refined\nscreenshot w.png\n"
           "key .\nexpect a.bias slope\nkey ,\nexpect a.bias constant\n"
           "key ]\nexpect a.map-size 128\nexpect b.map-size 128\n"
           "save s.json\nset a.bias none\nset b.show truth\ndrop s.json\n"
           "expect a.bias constant\nexpect b.show difference\nwait-refined\n"
           "drop broken.glb\nwait-refined\nexpect-problem broken.glb\nexpect scene lshape\n"
           "drop broken.json\nexpect-problem no JSON\n"
           "drop nothing.txt\nexpect-problem nothing.txt\n"
           "set a.constant-offset 0.5\nwait-refined\nexpect-problem\n"
           "resize 400 300\nwait-refined\nresize 90 70\nwait-frames 3\nminimise\nwait-frames 3\nrestore\n"
           "resize 1000 700\nwait-refined\nlose-device\nset a.map-size 32\nwait-refined\nexpect-problem\n"
           "picture before.png\nlose-device window\nwait-frames 2\nexpect-problem\nscreenshot after.png\n"
           "picture after-loss.png\n");
  expectFine(played);
}

TEST_F(WindowTest, FogIsShownAndTurned) {
  expectFine(shell(fmt::format("'{}' scene --density puff --for grate -o puff.vdb", test::inBuild("gnomon"))));
  const Result played =
      play("grate --size 96 --vsv-size 128x64x128 --map-size 128",
           "key f\nwait-refined\ncommand\npicture a.png\n"
           "key tab\nset b.integrator march\nwait-refined\npicture b.png b\nkey tab\n"
           "drop puff.vdb\nset fog.density-turn 30\nset a.steps 16\nset a.show medium\nwait-refined\nexpect-problem\n"
           "command\npicture c.png\n");
  expectFine(played);
  std::vector<std::string> commands;
  for (size_t from = played.out.find("gnomon fog"); from != std::string::npos;
       from = played.out.find("gnomon fog", from + 1))
    commands.push_back(played.out.substr(from, played.out.find('\n', from) - from));
  ASSERT_EQ(commands.size(), 2u) << played.out;
  for (size_t i = 0; i < 2; ++i) {
    expectFine(shell(fmt::format("'{}'{}", test::inBuild("gnomon"), commands[i].substr(std::string("gnomon").size()))));
    expectSame("picture.png", i == 0 ? "a.png" : "c.png");
  }
}

// lavapipe's multiview draws other slices, and is refused each time.
TEST_F(WindowTest, AMapThatCannotBeDrawnIsToldEachTime) {
  const Result played = play("lshape --light lamp --size 64 --map-size 64 --biases witness --show labels",
                             "wait-refined\nset a.cube-passes multiview\nwait-refined\nset loupe on\nwait-refined\n"
                             "set unfolded on\nwait-refined\nexpect-problem --cube-passes multiview\n"
                             "set a.cube-passes six\nwait-refined\nexpect-problem\n");
  expectFine(played);
}

// A bias's file is edited and dropped again, and again: neither its name nor its address tells which one it is.
TEST_F(WindowTest, ABiasThatIsReadAgainIsAnother) {
  std::string script;
  for (int i = 0; i < 6; ++i) {
    writeTextFile(folder() / std::to_string(i) / "mine.glsl",
                  fmt::format("bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {{\n"
                              "  return {};\n}}\n",
                              i % 2 == 0));
    script += fmt::format("set a.bias {0}/mine.glsl\nwait-refined\npicture {0}.png\n", i);
  }
  writeTextFile(folder() / "endless.glsl",
                "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {\n"
                "  while (true) {}\n  return true;\n}\n");
  script += "drop endless.glsl\nwait-refined\nexpect-problem nothing ends\nexpect a.bias 5/mine.glsl\n";
  expectFine(play("lshape --size 64 --map-size 64", script));
  for (int i = 2; i < 6; ++i) expectSame(fmt::format("{}.png", i), fmt::format("{}.png", i % 2));
  EXPECT_NE(readFile(folder() / "0.png"), readFile(folder() / "1.png"));
}

TEST_F(WindowTest, ATurntableIsWritten) {
  const Result played = play("lshape --size 64 --map-size 64", "wait-refined\nkey p\nkey p\nturntable turn 3 light\n");
  expectFine(played);
  EXPECT_EQ(readFile(folder() / "gnomon-view-0001.png"), readFile(folder() / "gnomon-view-0002.png"));
  for (const char* file : {"turn/frames/0000.png", "turn/frames/0001.png", "turn/frames/0002.png"})
    EXPECT_TRUE(std::filesystem::exists(folder() / file)) << file;
  EXPECT_NE(readFile(folder() / "turn/frames/0000.png"), readFile(folder() / "turn/frames/0001.png"));
  const bool hasFfmpeg = shell("command -v ffmpeg").exitCode == 0;
  EXPECT_EQ(std::filesystem::exists(folder() / "turn/frames.mp4"), hasFfmpeg);
  if (hasFfmpeg) {
    EXPECT_EQ(readFile(folder() / "turn/frames.mp4").substr(4, 4), "ftyp");
  }
}

// Real key presses and a real mouse, through the X server.
TEST_F(WindowTest, XEventsArrive) {
  const Result result = viewByHand("lshape --size 128 --map-size 64 --window 1000x700 --session s.json",
                                   "$x key --delay 0 Tab; sleep 1; $x mousedown 1; sleep 1; $x mousemove 740 320; "
                                   "sleep 1; $x mouseup 1; sleep 0.5; $x key --delay 0 ctrl+s");
  expectFine(result);
  const auto session = nlohmann::json::parse(readFile(folder() / "s.json"));
  EXPECT_EQ(session["split"], "on");
  EXPECT_TRUE(session["camera"].get<std::string>().starts_with("eye:")) << session["camera"];
}

// What is pressed while a frame takes long comes in its order, let go again or not, each with its own modifiers.
TEST_F(WindowTest, KeysOfALongFrameComeInTheirOrder) {
  const Result result = viewByHand("lshape --size 128 --map-size 64 --window 1000x700 --session s.json",
                                   "pid=$($x getwindowpid $id); kill -STOP $pid; "
                                   "$x key --delay 0 l Tab ctrl+s Tab; $x keydown ctrl keydown q; kill -CONT $pid; "
                                   "sleep 1; $x keyup q keyup ctrl");
  expectFine(result);
  const auto session = nlohmann::json::parse(readFile(folder() / "s.json"));
  EXPECT_EQ(session["split"], "on");
  EXPECT_EQ(session["loupe"], "on");
}

// So does a mouse: a whole drag is one, from where it went down to where it came up.
TEST_F(WindowTest, ADragOfALongFrameMovesWhatItBeganOn) {
  // The edge of the split, which is where the picture's middle is.
  expectFine(viewByHand("lshape --size 128 --map-size 64 --window 1000x700 --session s.json",
                        "$x key --delay 0 Tab; sleep 1; pid=$($x getwindowpid $id); kill -STOP $pid; "
                        "$x mousemove 665 400 mousedown 1 mousemove 825 420 mouseup 1 mousemove 700 300; "
                        "kill -CONT $pid; sleep 1; $x key --delay 0 ctrl+s"));
  const auto session = nlohmann::json::parse(readFile(folder() / "s.json"));
  EXPECT_NEAR(std::stod(session.value("split-at", "0")), 0.75, 0.02) << session;
  EXPECT_EQ(session.value("camera", ""), "") << session;
}

// The wheel, too; and what one key takes back is one thing. (The X server takes a key again within 20 ms for held.)
TEST_F(WindowTest, WheelAndDragOfALongFrameAreStepsOfTheirOwn) {
  expectFine(viewByHand(
      "lshape --size 128 --map-size 64 --window 1000x700 --session s.json",
      "pid=$($x getwindowpid $id); kill -STOP $pid; "
      "$x mousemove 665 400 mousedown 1 mousemove 725 400 mouseup 1 key --delay 0 2 ctrl+z ctrl+s; "
      "kill -CONT $pid; sleep 1; cp s.json dragged.json; kill -STOP $pid; "
      "$x click 4 key --delay 0 ctrl+z; sleep 0.1; $x key --delay 0 ctrl+z ctrl+s; kill -CONT $pid; sleep 1"));
  const auto dragged = nlohmann::json::parse(readFile(folder() / "dragged.json"));
  EXPECT_TRUE(dragged.value("camera", "").starts_with("eye:")) << dragged;
  EXPECT_EQ(dragged.value("a.show", ""), "beauty");
  EXPECT_EQ(nlohmann::json::parse(readFile(folder() / "s.json")).value("camera", ""), "");
}

// A number typed into a slider, the one of the split's edge: the click comes before the digits, and they before Enter.
TEST_F(WindowTest, ANumberIsTypedInALongFrame) {
  expectFine(viewByHand("lshape --size 128 --map-size 64 --window 1000x700 --session s.json",
                        "$x key --delay 0 Tab; sleep 1; pid=$($x getwindowpid $id); kill -STOP $pid; "
                        "$x mousemove 105 225 keydown ctrl click 1 keyup ctrl key --delay 0 0 period 4 4 BackSpace; "
                        "sleep 0.1; $x key --delay 0 BackSpace 2 5 Return ctrl+s; kill -CONT $pid; sleep 1; "
                        "cp s.json typed.json; $x key --delay 0 ctrl+z; sleep 1; $x key --delay 0 ctrl+s"));
  const auto edgeIn = [&](const char* file) {
    return nlohmann::json::parse(readFile(folder() / file)).value("split-at", "");
  };
  EXPECT_EQ(edgeIn("typed.json"), "0.25");
  EXPECT_EQ(edgeIn("s.json"), "0.5");  // one step, not one a digit
}

// Held on when Ctrl is let go, S is no flight backwards.
TEST_F(WindowTest, AKeyThatWasPressedWithCtrlDoesNotFly) {
  expectFine(viewByHand("lshape --size 128 --map-size 64 --window 1000x700 --session s.json",
                        "$x keydown ctrl keydown s; sleep 0.5; $x keyup ctrl; sleep 1; $x keyup s; sleep 0.5; "
                        "$x key --delay 0 ctrl+s"));
  EXPECT_EQ(nlohmann::json::parse(readFile(folder() / "s.json")).value("camera", ""), "");
}

TEST_F(WindowTest, AScreenshotHasTheProblem) {
  writeTextFile(folder() / "bad.glsl", "nonsense\n");
  expectFine(
      play("lshape --size 96 --map-size 64",
           "wait-refined\nscreenshot before.png\ndrop bad.glsl\nscreenshot after.png\nexpect-problem userLit\n"));
  EXPECT_NE(readFile(folder() / "before.png"), readFile(folder() / "after.png"));
}

TEST_F(WindowTest, AnythingMayHappen) {
  const Result played = play("lshape --size 96 --map-size 64", "wait-refined\nrandom 300 7\nwait-frames 2\n");
  expectFine(played);
}

TEST_F(WindowTest, MistakesAreOneLine) {
  const auto expectMistake = [&](const Result& result, int exitCode, const std::string& what) {
    EXPECT_EQ(result.exitCode, exitCode) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  expectMistake(shell(fmt::format("DISPLAY= WAYLAND_DISPLAY= '{}' view lshape", test::inBuild("gnomon"))), 1,
                "xvfb-run");
  expectMistake(shell(fmt::format("'{}' view lshape --window 12", test::inBuild("gnomon")) + "x"), 2, "12x");
  expectMistake(play("lshape", "fly away\n"), 1, "script:1: fly: no such verb");
  expectMistake(play("lshape --size 64", "wait-refined\nexpect split on\n"), 1, "script:2: split is 'off', not 'on'");
  expectMistake(play("lshape --size 64", "set a.bias biass\n"), 1, "script:1: ");
  expectMistake(play("lshape --size 64", "wait-refined\nset light nosuch\nwait-refined\npicture p.png\n"), 1,
                "script:4: there is no picture of this: --light nosuch");
  expectMistake(view("nosuchscene --frames 3"), 1, "nosuchscene");
  expectMistake(view("lshape --frames 3 --window 0x5"), 2, "--window 0x5");
  expectMistake(view("lshape --frames 3 --ui-scale nan"), 2, "nan");
  // A light has a place as soon as there is a scene.
  expectFine(play("lshape --light lamp --size 64", "set light.x 0.5\nexpect light.x 0.5\n"));
}

}  // namespace
}  // namespace gnomon
