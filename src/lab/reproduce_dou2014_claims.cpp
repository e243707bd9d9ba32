#include "lab/reproduce_dou2014.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr const char* kPaper = "dou2014";

// Figures 1 and 6 say the same of two views.
void addInterior(std::vector<Claim>& all, const std::string& id) {
  const auto in = [&](std::string text) {
    for (size_t at = text.find('#'); at != std::string::npos; at = text.find('#')) text.replace(at, 1, id);
    return text;
  };
  all.push_back({kPaper,
                 id,
                 "A constant shows acne and detachment.",
                 "the constant that is best for the picture",
                 {in("acne(# constant) >= 0.02% scored(# constant)"),
                  in("leak(# constant) >= 0.02% scored(# constant)")}});
  all.push_back(
      {kPaper,
       id,
       "A slope-scaled bias shows acne and detachment.",
       "factor and offset that are best for the picture",
       {in("acne(# slope) >= 0.02% scored(# slope)"), in("leak(# slope) >= 0.02% scored(# slope)")}});
  all.push_back({kPaper,
                 id,
                 "The adaptive bias has no visible acne.",
                 "K = 0.0001",
                 {in("acne(# adaptive) < 0.002% scored(# adaptive)")}});
  all.push_back({kPaper,
                 id,
                 "It keeps more detail of shadows than constant and slope-scaled biases.",
                 "K = 0.0001",
                 {in("leak(# adaptive) < leak(# constant)"), in("leak(# adaptive) < leak(# slope)")}});
  all.push_back({kPaper,
                 id,
                 "It equals dual layers.",
                 "K = 0.0001; dual with its best offset",
                 {in("error(# adaptive) <= 1.1 error(# dual)")}});
}

void addMaps(std::vector<Claim>& all) {
  addInterior(all, "1");
  addInterior(all, "6");
  all.push_back({kPaper,
                 "7",
                 "A constant leaves acne on what is near and detachment on what is far.",
                 "the constant whose worse view is best",
                 {"acne(7 near constant) >= 0.02% scored(7 near constant)",
                  "leak(7 far constant) >= 0.02% scored(7 far constant)"}});
  all.push_back({kPaper,
                 "7",
                 "So does a slope-scaled bias.",
                 "the factor whose worse view is best",
                 {"acne(7 near slope) >= 0.02% scored(7 near slope)",
                  "leak(7 far slope) >= 0.02% scored(7 far slope)"}});
  all.push_back(
      {kPaper,
       "7",
       "No constant is right for both views, and the adaptive bias is far better.",
       "the constant whose worse view is best; K = 0.0001; far better is a quarter",
       {"max(error(7 near constant), error(7 far constant)) >= 0.02%",
        "max(error(7 near adaptive), error(7 far adaptive)) < max(error(7 near constant), error(7 far "
        "constant)) / 4"}});
  all.push_back({kPaper,
                 "7",
                 "The adaptive bias has no acne on what is near.",
                 "K = 0.0001",
                 {"acne(7 near adaptive) < 0.002% scored(7 near adaptive)"}});
  all.push_back({kPaper,
                 "7",
                 "It has no detachment on what is far.",
                 "K = 0.0001",
                 {"leak(7 far adaptive) < 0.002% scored(7 far adaptive)"}});
  all.push_back({kPaper,
                 "9",
                 "Its noise sits where the surface is almost parallel to the light.",
                 "acne and leak on the sun's map; almost parallel: within 6 degrees; most is more than half",
                 {"pixels(9 of them edge-on) > 50% pixels(9 acne and leak)",
                  "cosine(9 acne and leak) < cosine(9 lit) / 2"}});
  all.push_back(
      {kPaper,
       "9",
       "Shading makes it invisible.",
       "the cosine by which Lambertian shading weighs it; invisible is less than a tenth of what is lit",
       {"cosine(9 acne and leak) < cosine(9 lit) / 2", "cosine(9 acne and leak) < cosine(9 lit) / 10"}});
  all.push_back(
      {kPaper,
       "12",
       "A map of 1024 × 1024 texels lets it remove most false shadow.",
       "the whole scene in the map; against no bias",
       {"acne(12 1024) < acne(12 1024, no bias) / 2", "acne(12 1024) < acne(12 1024, no bias) / 10"}});
  all.push_back({kPaper,
                 "12",
                 "At 512 × 512 false shadow appears, and detachment.",
                 "the same",
                 {"acne(12 512) > 1.1 acne(12 1024)", "leak(12 512) > 1.1 leak(12 1024)"}});
}

void addVolumes(std::vector<Claim>& all) {
  all.push_back(
      {kPaper,
       "8",
       "With a constant, a shadow volume shows acne, and detachment already.",
       "resampled, full sphere; the constant that is best for the picture",
       {"acne(8 constant) >= 0.02% scored(8 constant)", "leak(8 constant) >= 0.02% scored(8 constant)"}});
  all.push_back({kPaper,
                 "8",
                 "The adaptive bias reduces the acne.",
                 "the same volume",
                 {"acne(8 adaptive) < acne(8 constant)"}});
  all.push_back({kPaper,
                 "8",
                 "It keeps more detail of shadows at the same time.",
                 "the same volume",
                 {"leak(8 adaptive) < leak(8 constant)"}});
  all.push_back(
      {kPaper,
       "13",
       "Behind the viewer, 1024 × 1024 × 512 voxels let it remove most acne.",
       "resampled, full sphere; against no bias",
       {"acne(13 1024) < acne(13 1024, no bias) / 2", "acne(13 1024) < acne(13 1024, no bias) / 10"}});
  all.push_back({kPaper,
                 "13",
                 "At 512 × 512 × 512 voxels acne appears.",
                 "the same",
                 {"acne(13 512) > 1.1 acne(13 1024)"}});
}

void addTimes(std::vector<Claim>& all) {
  all.push_back({kPaper,
                 "section 4",
                 "A slope-scaled bias costs around 5% more than a constant.",
                 "the paper's own table 1",
                 {"1 <= published(slope) <= 1.1"}});
  all.push_back({kPaper,
                 "section 4",
                 "The adaptive bias costs around 20% more than a constant.",
                 "the paper's own table 1",
                 {"1.1 <= published(adaptive) <= 1.3"}});
  all.push_back({kPaper,
                 "section 4",
                 "Dual layers cost close to 50% more than the adaptive bias.",
                 "the paper's own table 1",
                 {"1.4 <= published(dual) / published(adaptive) <= 1.6"}});
  all.push_back({kPaper,
                 "table 1",
                 "A slope-scaled bias costs around 5% more than a constant.",
                 "frames in rounds",
                 {"1 <= frame(slope) <= 1.1"}});
  all.push_back({kPaper,
                 "table 1",
                 "The adaptive bias costs around 20% more than a constant.",
                 "frames in rounds",
                 {"1.1 <= frame(adaptive) <= 1.3"}});
  all.push_back({kPaper,
                 "table 1",
                 "Dual layers cost close to 50% more than the adaptive bias.",
                 "frames in rounds",
                 {"1.4 <= frame(dual) / frame(adaptive) <= 1.6"}});
  all.push_back({kPaper,
                 "table 1",
                 "Two layers take twice as long to draw as one.",
                 "maps in rounds; twice is 1.7 to 2.5 times",
                 {"1.7 <= map_ms(dual) / map_ms(constant) <= 2.5"}});
  for (const char* map : {"paraboloid", "spot"}) {
    const auto dual = [&](int side) {
      return fmt::format("ratio({0} {1} dual) / ratio({0} {1} adaptive)", map, side);
    };
    all.push_back(
        {kPaper,
         "10",
         fmt::format("Dual layers cost 50% more than the adaptive bias, on {} maps below 4096 × 4096.", map),
         "frames in rounds; 40 to 60%",
         {"1.4 <= " + dual(512) + " <= 1.6", "1.4 <= " + dual(1024) + " <= 1.6",
          "1.4 <= " + dual(2048) + " <= 1.6"}});
    all.push_back({kPaper,
                   "10",
                   fmt::format("They cost more than that on larger {} maps.", map),
                   "frames in rounds",
                   {std::string(map) == "spot" ? dual(8192) + " > 1.5" : dual(4096) + " > 1.5"}});
  }
}

void addErrata(std::vector<Claim>& all) {
  all.push_back(
      {kPaper,
       "equation 6",
       "It takes the near end to 0 and the far end to 1.",
       "as printed",
       {"0 - 0.001 <= depth(equation 6, near) <= 0.001", "0.999 <= depth(equation 6, far) <= 1.001"}});
  all.push_back({kPaper,
                 "equation 6",
                 "It gives the depth that is compared.",
                 "a cube map's depth by equation 6 as printed, against b with the other sign",
                 {"wrong(equation 6, as printed) <= 1.1 wrong(equation 6, b with the other sign)"}});
  all.push_back({kPaper,
                 "section 3.2",
                 "R = 2 (d0 · N) d0 - d0 is the texel's ray.",
                 "as printed, against the unit normal",
                 {"wrong(section 3.2, the ray as printed) <= 1.1 wrong(section 3.2, the unit normal)"}});
  all.push_back({kPaper,
                 "section 3.2",
                 "N = (x, y, 1) / z is the paraboloid's normal.",
                 "the ray reflected at it as printed, against the unit normal",
                 {"wrong(section 3.2, the normal as printed) <= 1.1 wrong(section 3.2, the unit normal)"}});
  all.push_back({kPaper,
                 "section 3.2",
                 "(x, y, z) is as good a ray as its unit one.",
                 "distances along it as they come, against the unit normal",
                 {"wrong(section 3.2, the ray not normalized) <= 1.1 wrong(section 3.2, the unit normal)"}});
  all.push_back({kPaper,
                 "section 2.2",
                 "Epsilon is taken at the fragment; or, as algorithm 1 and the listings have it, elsewhere.",
                 "all three, which should agree within a tenth",
                 {"0.9 wrong(epsilon, at the occluder, as in algorithm 1) <= wrong(epsilon, at the fragment, "
                  "as in the text) <= 1.1 wrong(epsilon, at the occluder, as in algorithm 1)",
                  "0.9 wrong(epsilon, at the occluder, as in algorithm 1) <= wrong(epsilon, at the stored "
                  "depth, as in the listings) <= 1.1 wrong(epsilon, at the occluder, as in algorithm 1)"}});
  all.push_back({kPaper,
                 "section 2.1",
                 "The occluder's depth is taken wherever it lies.",
                 "as in the text, against the authors' shaders, which take no depth behind the fragment",
                 {"wrong(occluder, as in the text) <= 1.1 wrong(occluder, never behind the fragment, as in "
                  "the authors' shaders)"}});
}

}  // namespace

std::vector<Claim> douClaims() {
  std::vector<Claim> all;
  addMaps(all);
  addVolumes(all);
  addTimes(all);
  addErrata(all);
  return all;
}

}  // namespace gnomon
