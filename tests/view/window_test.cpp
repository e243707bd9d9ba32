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
for i in $(seq 200); do [ -s display ] && break; sleep 0.05; done
export DISPLAY=:$(cat display)
{}
timeout 60 '{}' view {}
code=$?
kill $server $person
exit $code
)",
                                                GNOMON_XVFB, before, test::inBuild("gnomon"), arguments));
    return shell("sh run");
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

TEST_F(WindowTest, ATurntableIsWritten) {
  const Result played = play("lshape --size 64 --map-size 64", "wait-refined\nturntable turn 3 light\n");
  expectFine(played);
  for (const char* file : {"turn/frames/0000.png", "turn/frames/0001.png", "turn/frames/0002.png"})
    EXPECT_TRUE(std::filesystem::exists(folder() / file)) << file;
  EXPECT_NE(readFile(folder() / "turn/frames/0000.png"), readFile(folder() / "turn/frames/0001.png"));
}

// Real key presses and a real mouse, through the X server.
TEST_F(WindowTest, XEventsArrive) {
  // Its title names the scene when the first picture is there. Keys are let go at once, as a quick hand does. Without a
  // window manager keys go where the pointer is until a window has the focus; the last ones are pressed until it is
  // gone.
  const std::string person = fmt::format(
      "( for i in $(seq 300); do id=$({0} search --onlyvisible --name Gnomon: 2>/dev/null | head -1); "
      "[ -n \"$id\" ] && break; sleep 0.1; done; {0} mousemove 700 300 windowfocus --sync $id; sleep 1; "
      "{0} key --delay 0 Tab; sleep 1; {0} mousedown 1; sleep 1; {0} mousemove 740 320; sleep 1; "
      "{0} mouseup 1; sleep 0.5; for i in $(seq 20); do {0} key --delay 0 ctrl+s; sleep 0.5; {0} key --delay 0 ctrl+q; "
      "sleep 1; done ) & person=$!",
      GNOMON_XDOTOOL);
  const Result result = view("lshape --size 128 --map-size 64 --window 1000x700 --session s.json", person);
  expectFine(result);
  const auto session = nlohmann::json::parse(readFile(folder() / "s.json"));
  EXPECT_EQ(session["split"], "on");
  EXPECT_TRUE(session["camera"].get<std::string>().starts_with("eye:")) << session["camera"];
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
  expectMistake(view("nosuchscene --frames 3"), 1, "nosuchscene");
}

}  // namespace
}  // namespace gnomon
