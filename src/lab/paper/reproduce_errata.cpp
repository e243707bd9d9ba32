#include "lab/core/maps.h"
#include "lab/paper/errata/errata.h"
#include "lab/paper/reproduce_dou2014.h"
#include "shadow/user_bias.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr int kPictureSide = 512, kCubeSide = 512, kParaboloidSide = 887,
              kSpotSide = 1024;  // 3 * 512^2 = 887^2

// Counts of one map under any bias.
class Counter {
 public:
  Counter(const Session& session, const char* map, int side)
      : passes_(session), lit_(openLight(session, passes_, *parseMaps(map).front(), {.side = side})) {}

  struct Counts {
    size_t wrong = 0, acne = 0, leak = 0;
  };
  Counts count(const Method& method) {
    const LabelledResult judged = lit_.judge(method);
    return {.wrong = lit_.receivers().scored - judged.labels.count(Label::Agree),
            .acne = judged.labels.count(Label::Acne),
            .leak = judged.labels.count(Label::Leak)};
  }
  Counts count(const char* bias, int epsilonAt = glsl::kEpsilonAtOccluder) {
    KnobChoices choices;
    choices.choices.epsilonAt = epsilonAt;
    return count(methodFor(lit_.view(), choices, findBias(bias)));
  }
  Counts countPrinted(const char* name, const char* glsl) {
    const std::unique_ptr<const UserBias> bias = readUserBias(name, glsl);
    return count(methodFor(lit_.view(), {}, bias->method));
  }
  std::string describe() const {
    return fmt::format("{} of {} texels a side, {} scored pixels", lit_.parameterization().name(), lit_.setup().side,
                       lit_.receivers().scored);
  }
  const glsl::ShadowMap& shape() const { return lit_.fitted().map; }

 private:
  ShadowPasses passes_;
  LightOnMap lit_;
};

// Equation 6 with the sign that the paper prints before b, of a depth of x = -metres.
double printedEquation6(double ln, double lf, double metres) {
  const double a = -(lf + ln) / (lf - ln);
  const double b = -2.0 * lf * ln / (lf - ln);
  const double x = -metres;
  return (-a * x + b) / (2.0 * x) + 0.5;
}

class ErrataTable {
 public:
  explicit ErrataTable(PaperRun& run) : run_(run) {}

  void line(const std::string& where, const std::string& what, const Counter::Counts& counts) {
    const std::string place = where + ", " + what;
    run_.number("wrong", place, static_cast<double>(counts.wrong));
    run_.number("acne", place, static_cast<double>(counts.acne));
    run_.number("leak", place, static_cast<double>(counts.leak));
    table_.rows.push_back(
        {place, fmt::format("{}", counts.wrong), fmt::format("{}", counts.acne), fmt::format("{}", counts.leak)});
  }
  void describe(const std::string& text) { table_.note += (table_.note.empty() ? "" : "; ") + text; }
  void finish() { run_.addTable(std::move(table_)); }

 private:
  PaperRun& run_;
  PaperTable table_{.id = "of errata",
                    .title = "The paper's equations as printed, and as meant: wrong pixels",
                    .note = {},
                    .columns = {"place, reading", "wrong pixels", "of them acne", "leak"},
                    .rows = {}};
};

}  // namespace

void runErrata(PaperRun& run) {
  const Session& session = run.open("atrium", "lantern", "court", run.scaled(kPictureSide));
  ErrataTable table(run);
  {
    Counter cube(session, "cube", run.scaled(kCubeSide));
    const double ln = cube.shape().zNear, lf = cube.shape().zFar;
    run.number("depth", "equation 6, near", printedEquation6(ln, lf, ln));
    run.number("depth", "equation 6, far", printedEquation6(ln, lf, lf));
    table.describe(cube.describe());
    table.line("equation 6", "as printed", cube.countPrinted("equation-6", kErrataEquation6Glsl));
    table.line("equation 6", "b with the other sign", cube.count("adaptive"));
  }
  {
    Counter paraboloid(session, "paraboloid", run.scaled(kParaboloidSide));
    table.describe(paraboloid.describe());
    table.line("section 3.2", "the ray as printed",
               paraboloid.countPrinted("ray-along-the-axis", kErrataRayAlongAxisGlsl));
    table.line("section 3.2", "the normal as printed",
               paraboloid.countPrinted("ray-of-the-long-normal", kErrataRayOfLongNormalGlsl));
    table.line("section 3.2", "the ray not normalized", paraboloid.countPrinted("ray-not-unit", kErrataRayNotUnitGlsl));
    table.line("section 3.2", "the unit normal", paraboloid.count("adaptive"));
  }
  Counter spot(session, "spot", run.scaled(kSpotSide));
  table.describe(spot.describe());
  table.line("epsilon", "at the fragment, as in the text", spot.count("adaptive", glsl::kEpsilonAtFragment));
  table.line("epsilon", "at the occluder, as in algorithm 1", spot.count("adaptive", glsl::kEpsilonAtOccluder));
  table.line("epsilon", "at the stored depth, as in the listings", spot.count("adaptive", glsl::kEpsilonAtStored));
  table.line("occluder", "as in the text", spot.count("adaptive"));
  table.line("occluder", "never behind the fragment, as in the authors' shaders", spot.count("adaptive-clamped"));
  table.finish();
}

}  // namespace gnomon
