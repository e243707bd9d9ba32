// The page: whole, self-contained, and alive whatever results.json and its folder hold.
#include "lab/page/report.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"

#include <functional>
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const fs::path kFixture = fs::path(test::inSource(GNOMON_TEST_FOLDER)) / "report";

// A copy of the fixture whose results.json the test changes.
class ReportTest : public ::testing::Test {
 protected:
  ReportTest() {
    fs::copy(kFixture, folder_, fs::copy_options::recursive);
    json_ = Json::parse(readFile(folder_ / "results.json"));
  }
  std::string page() const {
    writeTextFile(folder_ / "results.json", json_.dump());
    return reportHtml(folder_);
  }
  std::string complaint() const {
    try {
      page();
    } catch (const WorldError& error) {
      return error.what();
    }
    return "";
  }

  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
  Json json_;
};

std::vector<std::string> allMatches(const std::string& text, const char* pattern, int group = 1) {
  std::vector<std::string> found;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) found.push_back((*it)[group]);
  return found;
}

// Attributes `name` of all elements. By hand: data URIs are longer than std::regex's stack bears.
std::vector<std::string> attributes(const std::string& html, const std::string& name) {
  std::vector<std::string> values;
  const std::string key = " " + name + "=\"";
  for (size_t at = html.find(key); at != std::string::npos; at = html.find(key, at)) {
    at += key.size();
    const size_t end = html.find('"', at);
    values.push_back(html.substr(at, end - at));
    at = end;
  }
  return values;
}

std::string without(const std::string& html, const std::string& from, const std::string& to) {
  std::string out = html;
  for (size_t at = out.find(from); at != std::string::npos; at = out.find(from, at)) {
    const size_t end = out.find(to, at);
    out.erase(at, end == std::string::npos ? end : end + to.size() - at);
  }
  return out;
}

std::string withoutPictures(const std::string& html) {
  return without(html, "data:image/", "\"");
}

// Every element that is opened is closed, innermost first.
void expectWellFormed(const std::string& html) {
  std::string text = without(without(html, "<style>", "</style>"), "<script>", "</script>");
  text = without(text, "<!doctype", ">");
  const std::set<std::string> empty = {"meta", "link", "img", "br"};
  std::vector<std::string> open;
  for (size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const size_t end = text.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = text.substr(at + 1, end - at - 1);
    ASSERT_EQ(tag.find('<'), std::string::npos) << tag.substr(0, 80);
    const bool closes = tag[0] == '/';
    const std::string name = tag.substr(closes ? 1 : 0, tag.find_first_of(" \n/", 1) - (closes ? 1 : 0));
    if (closes) {
      ASSERT_FALSE(open.empty());
      ASSERT_EQ(name, open.back());
      open.pop_back();
    } else if (!tag.ends_with('/') && !empty.contains(name)) {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty()) << open.back();
}

void expectSound(const std::string& html) {
  expectWellFormed(html);
  const std::vector<std::string> ids = attributes(html, "id");
  const std::set<std::string> known(ids.begin(), ids.end());
  EXPECT_EQ(known.size(), ids.size()) << "an id occurs twice";
  for (const std::string& link : attributes(html, "href"))
    EXPECT_TRUE(link == "data:," || (link[0] == '#' && known.contains(link.substr(1)))) << link;
  for (const char* name : {"data-truth-visibility", "data-truth-beauty", "data-image", "aria-labelledby"})
    for (const std::string& id : attributes(html, name)) EXPECT_TRUE(known.contains(id)) << name << " " << id;
  EXPECT_EQ(html.find("{{"), std::string::npos);
  // The text of a template's name that was never set would leave an empty number.
  EXPECT_EQ(withoutPictures(html).find(" x=\"\""), std::string::npos);
}

std::string decodeBase64(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t held = 0;
  int bits = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const size_t digit = kDigits.find(c);
    EXPECT_NE(digit, std::string::npos);
    held = held << 6 | static_cast<uint32_t>(digit);
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(held >> (bits -= 8) & 255);
  }
  return bytes;
}

TEST_F(ReportTest, IsWholeAndTheSameEveryTime) {
  const std::string html = page();
  expectSound(html);
  EXPECT_EQ(html, page());
}

TEST_F(ReportTest, EveryPictureDecodesAndIsEmbeddedOnce) {
  const std::string html = page();
  const std::vector<std::string> sources = attributes(html, "src");
  const std::vector<std::string> widths = attributes(html, "width");
  std::set<std::string> seen;
  size_t jpegs = 0;
  for (const std::string& source : sources) {
    const bool jpeg = source.starts_with("data:image/jpeg;base64,");
    ASSERT_TRUE(jpeg || source.starts_with("data:image/png;base64,")) << source.substr(0, 40);
    const std::string bytes = decodeBase64(source.substr(source.find(',') + 1));
    const Image8 image = decodeImage(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), "picture");
    EXPECT_TRUE(image.width == 96 || image.width == 64) << image.width;
    EXPECT_TRUE(seen.insert(source).second) << "embedded twice";
    jpegs += jpeg ? 1 : 0;
  }
  // 3 methods of 4 pictures, 3 more through the filter; depth and the truth, plain and filtered, in 2
  // pictures each. The tuned row and the filtered row's labels name files that others name as well.
  EXPECT_EQ(sources.size(), 3 * 4 + 3 + 1 + 2 + 2u);
  EXPECT_EQ(jpegs, 3 + 1 + 1 + 1u);
}

TEST_F(ReportTest, NamesNothingOutsideItself) {
  const std::string html = withoutPictures(page());
  EXPECT_TRUE(allMatches(html, "(https?:|url\\(|@import|src=\"[^ ]|<link rel=\"style)", 0).empty());
}

TEST_F(ReportTest, EscapesWhatTheSceneIsCalled) {
  json_["rows"][0]["bias"] = "</script><b>\"'&";
  json_["rows"][0]["params"]["<i>"] = "<u>";
  json_["camera"]["name"] = "<img src=x onerror=alert(1)>";
  json_["maps"][0]["pictures"]["<s>"] = "spot/none.labels.png";
  const std::string html = page();
  expectSound(html);
  EXPECT_NE(html.find("<h1>L &lt;shape&gt; &amp; &quot;crease&quot;</h1>"), std::string::npos);
  for (const char* raw : {"<shape>", "<b>\"", "<i>\"", "<u>", "<img src=x", "<s>", "lamp <1>"})
    EXPECT_EQ(html.find(raw), std::string::npos) << raw;
  EXPECT_EQ(allMatches(withoutPictures(html), "</script>", 0).size(), 1u);
}

// Text of one column of the ranking, from the top.
std::vector<std::string> column(const std::string& html, const char* pattern) {
  const size_t begin = html.find("<tbody>", html.find("id=\"ranking\""));
  return allMatches(html.substr(begin, html.find("</tbody>", begin) - begin), pattern);
}

TEST_F(ReportTest, RanksByBiasErrorThenByAllWrongPixels) {
  for (Json& row : json_["rows"]) row["filter"] = "none";
  // Equal bias errors, told apart by their edges.
  json_["rows"][1]["edge_light"] = json_["rows"][1]["edge_light"].get<int>() + 7;
  json_["rows"][1]["agree"] = json_["rows"][1]["agree"].get<int>() - 7;
  const std::string html = page();
  const std::vector<std::string> names = column(html, "<th scope=\"row\"><a href=\"#row-\\d+\">([a-z]+)</a>");
  EXPECT_EQ(names, (std::vector<std::string>{"dual", "constant", "constant", "constant", "none"}));
  const std::vector<std::string> edges =
      column(html, "data-v=\"(\\d+)\"[^>]*>[^<]*</td>\n<td class=\"n\" data-v=\"[^\"]*\"[^>]*>0\\.");
  EXPECT_EQ(edges, (std::vector<std::string>{"26", "21", "21", "28", "12"}));
  EXPECT_NE(html.find("<a href=\"#row-1\">dual</a> is best at its default: bias error <b>0.0000"), std::string::npos);
  EXPECT_NE(
      html.find("Tuned for this very picture, <a href=\"#row-2\">constant tuned</a> is best: bias error <b>2.3917"),
      std::string::npos);
  EXPECT_EQ(allMatches(html, "<span class=\"tag crown\">([a-z ]+)</span>"),
            (std::vector<std::string>{"best at its default", "best tuned"}));
}

// The errors of dual, of constant through the filter, of constant tuned and not, and of none.
TEST_F(ReportTest, RanksAndPlotsByRmseWhereAFilterIsAskedFor) {
  json_["rows"][2]["given"] = true;
  const std::string html = page();
  const std::vector<std::string> names = column(html, "<th scope=\"row\"><a href=\"#row-\\d+\">([a-z]+)</a>");
  EXPECT_EQ(names, (std::vector<std::string>{"dual", "constant", "constant", "constant", "none"}));
  const std::vector<std::string> filters = column(html, "data-h=\"Filter\">([a-z]+)<");
  EXPECT_EQ(filters, (std::vector<std::string>{"none", "bilinear", "none", "none", "none"}));
  EXPECT_NE(html.find("dual</a> is best as given: RMSE <b>0.1016</b>"), std::string::npos);
  EXPECT_NE(html.find(">RMSE</text>"), std::string::npos);  // the plot's axis
  EXPECT_EQ(html.find(">bias error</text>"), std::string::npos);
}

TEST_F(ReportTest, AFilteredRowIsHeldAgainstTheFilteredTruth) {
  const std::string html = page();
  const std::vector<std::string> visibility = attributes(html, "data-truth-visibility");
  const std::vector<std::string> beauty = attributes(html, "data-truth-beauty");
  ASSERT_EQ(visibility.size(), 5u);
  ASSERT_EQ(beauty.size(), 5u);
  EXPECT_EQ(visibility[0], visibility[2]);
  EXPECT_NE(visibility[1], visibility[2]);  // the second is bilinear
  EXPECT_NE(beauty[1], beauty[2]);
  const size_t image = html.find("id=\"" + visibility[1] + "\"");
  EXPECT_EQ(html.find("Exact shadow, bilinear", image), html.find("Exact shadow", image));
}

TEST_F(ReportTest, TellsTuningPlacesAndTheCommandOfARow) {
  EXPECT_EQ(page().find("Command for this row"), std::string::npos);  // schema 2 has no commands of rows
  json_["rows"][1]["command"] = "gnomon compare 'l'\\''shape.glb' --maps spot --constant-offset 0.0125";
  const std::string html = page();
  EXPECT_NE(html.find("19 values tried"), std::string::npos);
  EXPECT_NE(html.find("camera balcony"), std::string::npos);
  EXPECT_NE(html.find("map of 32 × 32 texels"), std::string::npos);
  EXPECT_NE(html.find("data-x=\"28\" data-y=\"25\" data-size=\"16\""), std::string::npos);
  EXPECT_NE(html.find("<code>gnomon compare &apos;l&apos;\\&apos;&apos;shape.glb&apos; --maps spot "
                      "--constant-offset 0.0125</code>"),
            std::string::npos);
}

// Of one method that reached the limit on its second map, and one that did not.
TEST_F(ReportTest, ShowsTheSmallestMapsOfEqualError) {
  EXPECT_EQ(page().find("Equal error"), std::string::npos);
  const auto sized = [](int side, double wrong) {
    return Json{{"map_size", side},
                {"map_texels", 6 * side * side},
                {"map_bytes", 24 * side * side},
                {"all_wrong", wrong},
                {"build_ms", 2.5},
                {"shade_ms", 1.5},
                {"frame_ms", 5.0}};
  };
  json_["equal_error"] = {
      {"limit", 0.001},
      {"largest_map_size", 64},
      {"methods",
       {{{"map", "cube"},
         {"light", "lamp"},
         {"bias", "dual"},
         {"smallest", sized(32, 0.0005)},
         {"sizes", {sized(16, 0.02), sized(32, 0.0005)}}},
        {{"map", "cube"}, {"light", "lamp"}, {"bias", "<none>"}, {"smallest", nullptr}, {"sizes", {sized(64, 0.3)}}}}}};
  const std::string html = page();
  expectSound(html);
  EXPECT_NE(html.find("at most 0.1\u202f% of all pixels are wrong"), std::string::npos);
  EXPECT_NE(html.find("data-h=\"Texels a side\">32</td>"), std::string::npos);
  EXPECT_NE(html.find("data-h=\"Texels a side\">more than 64</td>"), std::string::npos);
  EXPECT_EQ(html.find("<none>"), std::string::npos);
  // Texels and frame time, each wide and narrow; two lines, three points, one of which is the smallest.
  EXPECT_EQ(allMatches(html, "class=\"plot lines", 0).size(), 4u);
  EXPECT_EQ(allMatches(html, "<path class=\"line-[0-9]+\" d=\"M[0-9. L-]+\"/>\n", 0).size(), 8u);
  EXPECT_EQ(allMatches(html, "<circle class=\"line-", 0).size(), 12u);
  EXPECT_EQ(allMatches(html, " smallest\"", 0).size(), 4u);
  json_["equal_error"]["methods"][0]["sizes"][0]["all_wrong"] = 2;
  EXPECT_NE(complaint().find("equal_error.methods[0].sizes[0].all_wrong must be at most 1"), std::string::npos)
      << complaint();
}

TEST_F(ReportTest, KnobsHaveTheUnitThatTheFileNames) {
  for (auto& row : json_["rows"]) row["tuning"] = nullptr;
  json_["rows"][1]["params"] = {{"offset", 0.25}, {"taps", 4}, {"texels", 1.5}};
  json_["rows"][1]["units"] = {{"offset", "m"}, {"texels", "texels"}};
  const std::string html = page();
  EXPECT_NE(html.find("offset\u00a00.25\u00a0m, texels\u00a01.5<"), std::string::npos);  // taps is none
}

TEST_F(ReportTest, SaysWhichPicturesAreMissing) {
  fs::remove(folder_ / "spot" / "dual.labels.png");
  writeTextFile(folder_ / "spot" / "none.beauty.png", "no picture");
  writeTextFile(folder_ / "spot" / "none.labels.png", std::string("\x89PNG\r\n\x1a\n", 8));
  const std::string around = "../" + folder_.filename().string() + "/spot/dual.visibility.png";
  const std::string absolute = (folder_ / "spot" / "dual.visibility.png").string();
  json_["rows"][1]["pictures"]["labels"] = around;
  json_["rows"][1]["pictures"]["beauty"] = absolute;
  const std::string html = page();
  expectSound(html);
  EXPECT_NE(html.find("6 pictures named in results.json cannot be read"), std::string::npos);
  for (const std::string& path :
       {std::string("spot/second_depth.png"), std::string("spot/dual.labels.png"), std::string("spot/none.beauty.png"),
        std::string("spot/none.labels.png"), around, absolute})
    EXPECT_NE(html.find(path), std::string::npos) << path;
}

TEST_F(ReportTest, SurvivesWithoutAnyPicture) {
  fs::remove_all(folder_ / "spot");
  const std::string html = page();
  expectSound(html);
  EXPECT_TRUE(attributes(html, "src").empty());
  EXPECT_TRUE(attributes(html, "data-truth-visibility").empty());
  EXPECT_EQ(column(html, "<th scope=\"row\">(<a)").size(), 5u);
}

TEST_F(ReportTest, SurvivesOneRowSixtyRowsAndNone) {
  const Json rows = json_["rows"];
  json_["rows"] = Json::array({rows[0]});
  expectSound(page());
  json_["rows"] = Json::array();
  for (int i = 0; i < 60; ++i) {
    Json row = rows[static_cast<size_t>(i) % rows.size()];
    row["map_size"] = 16 + i;
    json_["rows"].push_back(row);
  }
  const std::string many = page();
  expectSound(many);
  EXPECT_EQ(column(many, "<td class=\"n\" data-v=\"(\\d+)\">\\d+</td>\n<th").size(), 60u);
  json_["rows"] = Json::array();
  const std::string none = page();
  expectSound(none);
  EXPECT_NE(none.find("Nothing was compared."), std::string::npos);
}

TEST_F(ReportTest, ReadsSchema1) {
  json_["schema"] = 1;
  json_.erase("maps");
  for (Json& row : json_["rows"]) {
    for (const char* key : {"flip", "tuned", "tuning", "worst_acne", "worst_leak"}) row.erase(key);
    Json paths = Json::array();
    for (const auto& [kind, path] : row["pictures"].items()) paths.push_back(path);
    row["pictures"] = paths;
  }
  const std::string html = page();
  expectSound(html);
  EXPECT_EQ(html.find(">FLIP<"), std::string::npos);
  EXPECT_EQ(attributes(html, "data-truth-visibility").size(), 5u);
  for (const char* kind : {"labels", "visibility", "beauty"})
    EXPECT_NE(html.find("data-kind=\"" + std::string(kind) + "\""), std::string::npos);
}

TEST_F(ReportTest, NamesTheFieldThatIsWrong) {
  const auto after = [&](const std::function<void(Json&)>& change) {
    const Json kept = json_;
    change(json_);
    const std::string line = complaint();
    json_ = kept;
    EXPECT_EQ(line.find('\n'), std::string::npos);
    return line;
  };
  EXPECT_NE(after([](Json& j) { j["schema"] = 5; }).find("has schema 5; this gnomon reads 1 to 4"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j.erase("schema"); }).find("schema is missing"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j = 5; }).find("must be an object"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j["rows"][2].erase("bias"); }).find("rows[2].bias is missing"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j["rows"][2]["acne"] = -1; }).find("rows[2].acne must be a whole"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j["rows"] = "x"; }).find("rows must be a list"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j["camera"]["width"] = 0; }).find("camera must have a width"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j["rows"][0]["worst_acne"]["size"] = 0; }).find("worst_acne.size"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j["rows"][0]["worst_acne"]["x"] = 99999; }).find("at most 16384"), std::string::npos);
  EXPECT_NE(after([](Json& j) { j["rows"][0]["pictures"]["labels"] = 3; }).find("pictures.labels must be a string"),
            std::string::npos);
  EXPECT_NE(after([](Json& j) { j["rows"][0]["agree"] = 1000000; }).find("rows[0].agree must be at most"),
            std::string::npos);
}

TEST(Report, ANewFolderAndAHalfFileAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(reportHtml(folder.path()), WorldError);
  EXPECT_THROW(reportHtml(folder.path() / "absent"), WorldError);
  for (const char* text : {"", "{", "[1, 2", "{\"schema\": 1e999}", "\xff"}) {
    writeTextFile(folder.path() / "results.json", text);
    EXPECT_THROW(reportHtml(folder.path()), WorldError) << text;
  }
}

}  // namespace
}  // namespace gnomon
