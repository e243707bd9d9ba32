// A folder holds the results of one run, whole, whenever it is looked at.
#include "lab/results/result_folder.h"
#include "base/error.h"
#include "tests/base/temporary_folder.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class ResultFolderTest : public ::testing::Test {
 protected:
  static void write(const ResultFolder& folder, const std::string& text, const std::vector<std::string>& pictures) {
    for (const std::string& picture : pictures) writeTextFile(folder.aside() / picture, text + picture);
    const nlohmann::json json = {{"run", text}, {"files", folder.files()}};
    writeTextFile(folder.aside() / "results.json", json.dump());
    writeTextFile(folder.aside() / "report.html", text);
  }
  void publish(const std::string& text, const std::vector<std::string>& pictures) const {
    ResultFolder folder(path_, "results.json");
    write(folder, text, pictures);
    folder.publish();
  }
  std::vector<std::string> contents() const {
    std::vector<std::string> paths;
    for (const auto& entry : fs::recursive_directory_iterator(path_))
      if (!entry.is_directory()) paths.push_back(entry.path().lexically_relative(path_).generic_string());
    std::ranges::sort(paths);
    return paths;
  }
  const test::TemporaryFolder temporary_;
  const fs::path path_ = temporary_.path() / "out";
};

using Paths = std::vector<std::string>;

TEST_F(ResultFolderTest, ARunReplacesWhatTheOneBeforeListed) {
  publish("a", {"spot/1.png", "cube/2.png"});
  EXPECT_EQ(contents(), (Paths{"cube/2.png", "report.html", "results.json", "spot/1.png"}));
  writeTextFile(path_ / "spot" / "notes.txt", "mine");
  publish("b", {"spot/1.png", "spot/3.png"});
  EXPECT_EQ(contents(), (Paths{"report.html", "results.json", "spot/1.png", "spot/3.png", "spot/notes.txt"}));
  EXPECT_FALSE(fs::exists(path_ / "cube"));
  EXPECT_EQ(readFile(path_ / "spot" / "1.png"), "bspot/1.png");
}

TEST_F(ResultFolderTest, ARunThatEndsEarlyLeavesWhatThereWas) {
  {
    const ResultFolder folder(path_, "results.json");
    write(folder, "never", {"spot/1.png"});
  }
  EXPECT_FALSE(fs::exists(path_));
  publish("a", {"spot/1.png"});
  {
    const ResultFolder folder(path_, "results.json");
    write(folder, "b", {"spot/1.png"});
    EXPECT_EQ(readFile(path_ / "spot" / "1.png"), "aspot/1.png");
  }
  EXPECT_EQ(contents(), (Paths{"report.html", "results.json", "spot/1.png"}));
  EXPECT_EQ(readFile(path_ / "report.html"), "a");
}

TEST_F(ResultFolderTest, TheOldResultsFileIsTheFirstToGoAndTheNewOneTheLastToCome) {
  publish("a", {"1.png", "2.png"});
  ResultFolder folder(path_, "results.json");
  write(folder, "b", {"1.png", "2.png"});
  fs::remove(path_ / "2.png");
  fs::create_directories(path_ / "2.png" / "in the way");
  EXPECT_THROW(folder.publish(), WorldError);
  EXPECT_FALSE(fs::exists(path_ / "results.json"));
  EXPECT_EQ(readFile(path_ / "1.png"), "b1.png");
}

TEST_F(ResultFolderTest, TwoAtOnceAreRefused) {
  const ResultFolder first(path_, "results.json");
  try {
    const ResultFolder second(path_, "results.json");
    FAIL();
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("another gnomon is writing there"), std::string::npos) << error.what();
  }
}

TEST_F(ResultFolderTest, ALinkToAFolderThatIsNotThereMakesIt) {
  fs::create_symlink("there", temporary_.path() / "link");
  {
    ResultFolder folder(temporary_.path() / "link", "results.json");
    writeTextFile(folder.aside() / "results.json", "{}");
    folder.publish();
  }
  EXPECT_TRUE(fs::is_symlink(temporary_.path() / "link"));
  EXPECT_EQ(readFile(temporary_.path() / "there" / "results.json"), "{}");
}

TEST_F(ResultFolderTest, AListOfFilesElsewhereRemovesNothingThere) {
  const std::string outside = "precious";
  writeTextFile(temporary_.path() / "outside", outside);
  publish("a", {"1.png"});
  writeTextFile(path_ / "own.png", "mine");
  // The first has the right checksum, and lies elsewhere; the second has another.
  writeTextFile(path_ / "results.json", R"({"files": ["aacf852e ../outside", "00000000 own.png", "short"]})");
  publish("b", {"1.png"});
  EXPECT_EQ(readFile(temporary_.path() / "outside"), outside);
  EXPECT_EQ(readFile(path_ / "own.png"), "mine");
}

TEST_F(ResultFolderTest, AFileOfAnotherRunIsFound) {
  publish("a", {"1.png", "2.png"});
  const auto json = nlohmann::json::parse(readFile(path_ / "results.json"));
  const auto files = json.at("files").get<FileSums>();
  checkFiles(path_, files);
  fs::remove(path_ / "1.png");
  checkFiles(path_, files);  // a page says itself what is missing
  writeTextFile(path_ / "2.png", "c2.png");
  EXPECT_THROW(checkFiles(path_, files), WorldError);
}

}  // namespace
}  // namespace gnomon
