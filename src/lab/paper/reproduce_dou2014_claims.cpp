#include "lab/paper/reproduce_dou2014.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

Claim claim(const std::string& figure, const std::string& says, const std::string& run,
            const std::vector<std::string>& conditions) {
  return {.paper = "dou2014", .figure = figure, .says = says, .run = run, .conditions = conditions};
}

using Claims = std::vector<Claim>;

// Figures 1 and 6 say the same of two views.
Claims interior(const std::string& id) {
  const auto in = [&](std::string text) {  // '#' stands for the figure
    for (size_t at = text.find('#'); at != std::string::npos; at = text.find('#')) text.replace(at, 1, id);
    return text;
  };
  return {
      claim(id, "A constant shows acne and detachment.", "the best constant for the picture",
            {in("acne(# constant) >= 0.02% scored(# constant)"), in("leak(# constant) >= 0.02% scored(# constant)")}),
      claim(id, "A slope-scaled bias shows acne and detachment.", "the best factor and offset for the picture",
            {in("acne(# slope) >= 0.02% scored(# slope)"), in("leak(# slope) >= 0.02% scored(# slope)")}),
      claim(id, "The adaptive bias has no visible acne.", "K = 0.0001",
            {in("acne(# adaptive) < 0.002% scored(# adaptive)")}),
      claim(id, "It keeps more detail of shadows than constant and slope-scaled biases.", "K = 0.0001",
            {in("leak(# adaptive) < leak(# constant)"), in("leak(# adaptive) < leak(# slope)")}),
      claim(id, "It equals dual layers.", "K = 0.0001; dual with its best offset",
            {in("error(# adaptive) <= 1.1 error(# dual)")}),
  };
}

Claims figure7() {
  return {
      claim("7", "A constant leaves acne near the light and detachment far from it.",
            "the best constant in metres for both views",
            {"acne(7 near constant) >= 0.02% scored(7 near constant)",
             "leak(7 far constant) >= 0.02% scored(7 far constant)"}),
      claim("7", "A constant leaves acne near the light and detachment far from it.",
            "the best constant in a cube map's compressed depth for both views",
            {"acne(7 near constant, compressed) >= 0.02% scored(7 near constant, compressed)",
             "leak(7 far constant, compressed) >= 0.02% scored(7 far constant, compressed)"}),
      claim("7", "So does a slope-scaled bias.", "the best factor for both views",
            {"acne(7 near slope) >= 0.02% scored(7 near slope)", "leak(7 far slope) >= 0.02% scored(7 far slope)"}),
      claim("7", "No constant is right for both views, and the adaptive bias is far better.",
            "the best constant in metres for both views; K = 0.0001; far better means a quarter of the error",
            {"max(error(7 near constant), error(7 far constant)) >= 0.02%",
             "max(error(7 near adaptive), error(7 far adaptive)) < max(error(7 near constant), error(7 far "
             "constant)) / 4"}),
      claim("7", "The adaptive bias has no acne near the light.", "K = 0.0001",
            {"acne(7 near adaptive) < 0.002% scored(7 near adaptive)"}),
      claim("7", "It has no detachment far from the light.", "K = 0.0001",
            {"leak(7 far adaptive) < 0.002% scored(7 far adaptive)"}),
  };
}

Claims figure8() {
  return {
      claim("8", "With a constant, a shadow volume shows acne, and detachment already.",
            "resampled, full sphere; the best constant for the picture",
            {"acne(8 constant) >= 0.02% scored(8 constant)", "leak(8 constant) >= 0.02% scored(8 constant)"}),
      claim("8", "The adaptive bias reduces the acne.", "resampled, full sphere",
            {"acne(8 adaptive) < acne(8 constant)"}),
      claim("8", "The adaptive bias reduces the acne.", "drawn directly into the columns, frustum",
            {"acne(8 adaptive, direct) < acne(8 constant, direct)"}),
      claim("8", "It keeps more detail of shadows at the same time.", "both volumes",
            {"leak(8 adaptive) < leak(8 constant)", "leak(8 adaptive, direct) < leak(8 constant, direct)"}),
  };
}

Claims limits() {
  return {
      claim("9", "Its noise sits where the surface is almost parallel to the light.",
            "acne and leak on the sun's map; almost parallel means within 6 degrees, most means more than half",
            {"pixels(9 of them edge-on) > 50% pixels(9 acne and leak)", "cosine(9 acne and leak) < cosine(9 lit) / 2"}),
      claim("9", "Shading makes it invisible.",
            "the cosine of Lambertian shading; invisible means less than a tenth of that of lit pixels",
            {"cosine(9 acne and leak) < cosine(9 lit) / 2", "cosine(9 acne and leak) < cosine(9 lit) / 10"}),
      claim("12", "A map of 1024 × 1024 texels lets it remove most false shadow.",
            "the map covers the whole scene; compared with no bias",
            {"acne(12 1024) <= acne(12 1024, no bias) / 2", "acne(12 1024) <= acne(12 1024, no bias) / 10"}),
      claim("12", "At 512 × 512 false shadow appears, and detachment.", "the map covers the whole scene",
            {"acne(12 512) > 1.1 acne(12 1024)", "leak(12 512) > 1.1 leak(12 1024)"}),
      claim("13", "Behind the viewer, 1024 × 1024 × 512 voxels let it remove most acne.",
            "resampled, full sphere; compared with no bias",
            {"acne(13 1024) <= acne(13 1024, no bias) / 2", "acne(13 1024) <= acne(13 1024, no bias) / 10"}),
      claim("13", "At 512 × 512 × 512 voxels acne appears.", "resampled, full sphere",
            {"acne(13 512) > 1.1 acne(13 1024)"}),
      claim("13", "At 512 × 512 × 512 voxels acne appears.", "drawn directly into the columns, full sphere",
            {"acne(13 512, direct) > 1.1 acne(13 1024, direct)"}),
  };
}

// What section 4 says of times: of the paper's own table, and of frames here.
Claims times() {
  Claims all = {
      claim("section 4", "A slope-scaled bias costs around 5% more than a constant.", "the paper's own table 1",
            {"1 <= published(slope) <= 1.1"}),
      claim("section 4", "The adaptive bias costs around 20% more than a constant.", "the paper's own table 1",
            {"1.1 <= published(adaptive) <= 1.3"}),
      claim("section 4", "Dual layers cost close to 50% more than the adaptive bias.", "the paper's own table 1",
            {"1.4 <= published(dual) / published(adaptive) <= 1.6"}),
      claim("table 1", "A slope-scaled bias costs around 5% more than a constant.", "frames, interleaved",
            {"1 <= frame(slope) <= 1.1"}),
      claim("table 1", "The adaptive bias costs around 20% more than a constant.", "frames, interleaved",
            {"1.1 <= frame(adaptive) <= 1.3"}),
      claim("table 1", "Dual layers cost close to 50% more than the adaptive bias.", "frames, interleaved",
            {"1.4 <= frame(dual) / frame(adaptive) <= 1.6"}),
      claim("table 1", "Two layers take twice as long to draw as one.",
            "maps, interleaved; twice means 1.7 to 2.5 times", {"1.7 <= map_ms(dual) / map_ms(constant) <= 2.5"}),
  };
  for (const std::string map : {"paraboloid", "spot"}) {
    const auto dual = [&](int side) { return fmt::format("ratio({0} {1} dual) / ratio({0} {1} adaptive)", map, side); };
    all.push_back(claim(
        "10", fmt::format("Below 4096 × 4096 dual layers cost 50% more than the adaptive bias: {} maps.", map),
        "frames, interleaved; 40 to 60%",
        {"1.4 <= " + dual(512) + " <= 1.6", "1.4 <= " + dual(1024) + " <= 1.6", "1.4 <= " + dual(2048) + " <= 1.6"}));
    all.push_back(claim("10", fmt::format("On larger maps they cost more than that: {} maps.", map),
                        fmt::format("frames, interleaved, {0} × {0}", map == "spot" ? 8192 : 4096),
                        {dual(map == "spot" ? 8192 : 4096) + " > 1.5"}));
  }
  return all;
}

// What the text says, word for word, and what it leaves open.
Claims errata() {
  const std::string occluder = "wrong(epsilon, at the occluder, as in algorithm 1)";
  const auto asGood = [](const std::string& place, const std::string& printed, const std::string& meant) {
    return std::vector<std::string>{fmt::format("wrong({0}, {1}) <= 1.1 wrong({0}, {2})", place, printed, meant)};
  };
  const auto nearOccluder = [&](const std::string& where) {
    return fmt::format("0.9 {0} <= wrong(epsilon, {1}) <= 1.1 {0}", occluder, where);
  };
  return {
      claim("equation 6", "It takes the near end to 0 and the far end to 1.", "as printed",
            {"0 - 0.001 <= depth(equation 6, near) <= 0.001", "0.999 <= depth(equation 6, far) <= 1.001"}),
      claim("equation 6", "It gives the depth that is compared.",
            "a cube map's depth by equation 6 as printed, compared with b of the other sign",
            asGood("equation 6", "as printed", "b with the other sign")),
      claim("section 3.2", "R = 2 (d0 · N) d0 - d0 is the texel's ray.", "as printed, against the unit normal",
            asGood("section 3.2", "the ray as printed", "the unit normal")),
      claim("section 3.2", "N = (x, y, 1) / z is the paraboloid's normal.",
            "the ray reflected at it as printed, compared with the unit normal",
            asGood("section 3.2", "the normal as printed", "the unit normal")),
      claim("section 3.2", "The ray needs no normalization, for none is printed.",
            "distances along (x, y, z), not normalized, compared with the unit normal",
            asGood("section 3.2", "the ray not normalized", "the unit normal")),
      claim("section 2.2",
            "Epsilon is taken at the fragment (algorithm 1: at the occluder; listings: at the stored depth).",
            "all three, which should agree within a tenth",
            {nearOccluder("at the fragment, as in the text"), nearOccluder("at the stored depth, as in the listings")}),
      claim("section 2.1", "The occluder's depth needs no bound, for none is printed.",
            "as in the text, compared with the authors' shaders, which clamp the depth to the fragment's",
            asGood("occluder", "as in the text", "never behind the fragment, as in the authors' shaders")),
  };
}

}  // namespace

std::vector<Claim> douClaims() {
  Claims all;
  for (const Claims& some : {interior("1"), interior("6"), figure7(), figure8(), limits(), times(), errata()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace gnomon
