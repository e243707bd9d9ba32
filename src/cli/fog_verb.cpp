#include "base/error.h"
#include "base/file.h"
#include "base/interrupt.h"
#include "base/suggest.h"
#include "base/terminal.h"
#include "cli/choice.h"
#include "cli/map_flags.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/output_flags.h"
#include "cli/scene_flags.h"
#include "cli/typed_command.h"
#include "cli/unused_flags.h"
#include "cli/verbs.h"
#include "lab/core/maps.h"
#include "lab/fog/density_sequence.h"
#include "lab/fog/fog.h"
#include "lab/fog/fog_motion.h"
#include "lab/fog/fog_pictures.h"
#include "lab/fog/fog_report.h"
#include "lab/page/report.h"
#include "lab/results/result_folder.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct FogFlags {
  SceneFlags scene;
  MapFlags map;  // --map-size, --cull and those of volumes
  std::string out, json;
  bool truth = false, noCache = false;
  std::optional<double> bound;
  std::string integrators;
  std::string steps;
  std::string marchMap = "cube";
  std::string sigmaS, sigmaA = "0";
  double g = 0.2;
  std::optional<double> reach;
  double ambient = 0.0;
  std::string density, densityAt;
  std::optional<double> densityScale;
  double densityTurn = 0.0;
  std::string show = "beauty";
  std::optional<int> repeats;
  int frames = 0;
  std::optional<int> firstFrame;
  std::string move;
  std::optional<float> exposure;
  const CLI::App* verb = nullptr;  // which knows what was given
};

// Of the reference. Steps through a density cost four times as much for each halving.
constexpr double kBound = 0.001, kDensityBound = 0.003;

constexpr int kMostSteps = 65536;

// Of --steps and --repeats, for whoever asks for numbers, and for a picture alone: it is integrated with the first of
// its steps, and with the second to tell how far off it is.
constexpr const char* kComparedSteps = "32,128,512";
constexpr const char* kPictureSteps = "64,32";
constexpr int kComparedRepeats = 5;
constexpr int kPictureRepeats = 1;

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) words.push_back(word);
  return words;
}

std::optional<double> numberOf(const std::string& text) {
  try {
    size_t used = 0;
    const double value = std::stod(text, &used);
    if (used == text.size() && std::isfinite(value)) return value;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

// "s" or "r,g,b", per metre.
glm::vec3 parseSpectrum(const char* flag, const std::string& text) {
  const std::vector<std::string> words = split(text);
  glm::vec3 spectrum(0.0f);
  for (size_t i = 0; i < 3; ++i) {
    const std::optional<double> value =
        words.size() == 1 || words.size() == 3 ? numberOf(words[words.size() == 1 ? 0 : i]) : std::nullopt;
    if (!value || *value < 0.0 || *value > 1e6)
      throw UsageError(fmt::format("{} {}: write one number or r,g,b, each 0..1e6 per metre", flag, text));
    spectrum[static_cast<int>(i)] = static_cast<float>(*value);
  }
  return spectrum;
}

template <typename Parse>
auto parseList(const char* flag, const std::string& list, const Parse& parse) {
  std::vector<decltype(parse(list))> items;
  for (const std::string& word : split(list)) {
    const auto item = parse(word);
    if (std::ranges::find(items, item) == items.end()) items.push_back(item);
  }
  if (items.empty()) throw UsageError(fmt::format("{}: give at least one", flag));
  return items;
}

int parseSteps(const std::string& text) {
  const std::optional<double> value = numberOf(text);
  if (!value || *value < 1.0 || *value > kMostSteps || *value != std::floor(*value))
    throw UsageError(fmt::format("--steps {}: give whole numbers of 1..{}, as in 32,128,512", text, kMostSteps));
  return static_cast<int>(*value);
}

std::string marchMaps() {
  std::string names;
  for (const Parameterization* map : parameterizations())
    if (map->looksAround()) names += (names.empty() ? "" : " or ") + std::string(map->name());
  return names;
}

const Parameterization* parseMarchMap(const std::string& name) {
  for (const Parameterization* map : parameterizations())
    if (map->looksAround() && map->name() == name) return map;
  std::vector<std::string> names;
  for (const Parameterization* map : parameterizations())
    if (map->looksAround()) names.emplace_back(map->name());
  const std::string nearest = nearestName(name, names);
  throw UsageError(fmt::format("--march-map {}: {}choose {}", name,
                               nearest.empty() ? "" : fmt::format("did you mean {}? ", nearest), marchMaps()));
}

// Of -o: a picture where it names one (a stream gets a PNG), else a folder.
bool namesFolder(const std::string& out) {
  const std::string extension = std::filesystem::path(out).extension().string();
  return !out.empty() && extension != ".exr" && extension != ".png" && !isStream(out);
}

DensityPlacement placementOf(const FogFlags& flags, const glm::dvec3& originW) {
  DensityPlacement placement{
      .scale = flags.densityScale.value_or(1.0), .turnDegrees = flags.densityTurn, .originW = originW};
  if (!(placement.scale >= 1e-6 && placement.scale <= 1e6))
    throw UsageError(fmt::format("--density-scale {}: give a scale factor, 1e-6..1e6", placement.scale));
  if (!flags.densityAt.empty()) placement.centerW = parsePlace("--density-at", flags.densityAt);
  return placement;
}

bool isSequence(const FogFlags& flags) {
  return DensitySequence::isOne(flags.density);
}

// Of a sequence the first frame's.
std::shared_ptr<const DensityGrid> densityOf(const FogFlags& flags, const glm::dvec3& originW) {
  if (flags.density.empty()) {
    if (!flags.densityAt.empty() || flags.densityScale || flags.densityTurn != 0.0)
      throw UsageError("--density-at, --density-scale and --density-turn need a --density");
    return nullptr;
  }
  const DensityPlacement placement = placementOf(flags, originW);
  const std::string file =
      isSequence(flags) ? DensitySequence(flags.density, flags.firstFrame, flags.frames).file(0) : flags.density;
  return std::make_shared<const DensityGrid>(file, placement);
}

// What changes from frame to frame; none where nothing does.
std::optional<FogMotion> motionOf(const FogFlags& flags, const glm::dvec3& originW) {
  if (isSequence(flags) && flags.frames == 0)
    throw UsageError(fmt::format("--density {}: the # stands for a frame's number; add --frames N, or name one file",
                                 flags.density));
  if (flags.firstFrame && !isSequence(flags))
    throw UsageError("--first-frame needs a sequence: --density smoke.####.vdb");
  if (!isSequence(flags) && flags.move.empty() != (flags.frames == 0))
    throw UsageError("--frames and --move: give both or neither");
  std::optional<FogMotion> motion;
  if (!flags.move.empty()) motion = parseMotion(flags.move, flags.frames);
  if (!isSequence(flags)) return motion;
  if (flags.frames < 2 || flags.frames > kMostFrames)
    throw UsageError(fmt::format("--frames {}: give 2..{} frames", flags.frames, kMostFrames));
  // Where the file places each; a centre given would hold still what moves.
  if (!flags.densityAt.empty())
    throw UsageError("--density-at: a sequence stays where its files place it; leave the flag out");
  if (!motion) motion = FogMotion{.frames = flags.frames};
  motion->densityAt = [sequence = DensitySequence(flags.density, flags.firstFrame, flags.frames),
                       placement = placementOf(flags, originW)](int frame) {
    return std::make_shared<const DensityGrid>(sequence.file(frame), placement);
  };
  return motion;
}

FogMedium fogMedium(const FogFlags& flags, const glm::dvec3& originW) {
  FogMedium medium{.sigmaA = parseSpectrum("--sigma-a", flags.sigmaA), .reach = flags.reach};
  if (!flags.sigmaS.empty()) medium.sigmaS = parseSpectrum("--sigma-s", flags.sigmaS);
  if (!(std::abs(flags.g) < 1.0)) throw UsageError(fmt::format("--g {}: must be between -1 and 1", flags.g));
  medium.g = static_cast<float>(flags.g);
  if (flags.reach && !(*flags.reach > 0.0 && *flags.reach < 1e9))
    throw UsageError(fmt::format("--reach {}: give metres, more than 0 and less than 1e9", *flags.reach));
  if (!(flags.ambient >= 0.0 && flags.ambient < 1e9))
    throw UsageError(fmt::format("--ambient {}: give cd/m^2, 0 or more and less than 1e9", flags.ambient));
  medium.ambient = static_cast<float>(flags.ambient);
  medium.density = densityOf(flags, originW);
  return medium;
}

std::vector<const Integrator*> chosenIntegrators(const std::string& names, bool compares) {
  if (!names.empty())
    return parseList("--integrators", names, [](const std::string& name) { return &findIntegrator(name); });
  std::vector<const Integrator*> all;
  for (const Integrator& integrator : integrators()) all.push_back(&integrator);
  if (!compares) all.resize(1);
  return all;
}

std::string integratorsHelp() {
  std::string help = "default: all, and the first alone where only a picture is asked for;";
  for (const Integrator& integrator : integrators()) help += fmt::format(" {}: {};", integrator.name, integrator.says);
  help.back() = '.';
  return help;
}

FogOptions fogOptions(const FogFlags& flags, const glm::dvec3& originW) {
  const std::optional<FogMotion> motion = motionOf(flags, originW);
  const bool folder = namesFolder(flags.out);
  // A picture alone needs one way to integrate; whoever asks for numbers wants all.
  const bool compares = folder || flags.truth || !flags.json.empty() || flags.out.empty();
  FogOptions options{.integrators = chosenIntegrators(flags.integrators, compares),
                     .steps = parseList("--steps",
                                        !flags.steps.empty() ? flags.steps
                                        : compares           ? kComparedSteps
                                                             : kPictureSteps,
                                        parseSteps),
                     .marchMap = parseMarchMap(flags.marchMap),
                     .map = flags.map.options,
                     .mapSide = flags.map.mapSize,
                     .cull = parseCullMode(flags.map.cull),
                     .medium = fogMedium(flags, originW),
                     .truth = flags.truth,
                     .cache = !flags.noCache,
                     .repeats = flags.repeats.value_or(compares ? kComparedRepeats : kPictureRepeats)};
  options.reference.bound = flags.bound.value_or(flags.density.empty() ? kBound : kDensityBound);
  if (!(options.reference.bound >= 1e-6 && options.reference.bound <= 1.0))
    throw UsageError(
        fmt::format("--bound {}: give a fraction of the picture's mean, 1e-6..1", options.reference.bound));
  options.exposure = flags.exposure;
  options.motion = motion;
  if (options.motion && !folder && !flags.truth)
    throw UsageError("--frames: give a folder with -o for the frames, or --truth to measure flicker");
  return options;
}

void tellUnusedFlags(const FogFlags& flags, const FogOptions& options) {
  const UnusedFlags unused(*flags.verb);
  unused.tellUnless(flags.truth, "--bound", "it is of the reference, which --truth makes");
  unused.tellUnless(flags.truth, "--no-cache", "it is of the reference, which --truth makes");
  const auto usesMap = [](const Integrator* integrator) { return integrator->reads == Integrator::Reads::Depths; };
  unused.tellUnless(std::ranges::any_of(options.integrators, usesMap), "--march-map",
                    "march is not among --integrators");
  // In a density every integrator takes steps.
  unused.tellUnless(options.medium.density != nullptr || std::ranges::any_of(options.integrators, usesMap), "--steps",
                    "march is not among the integrators, and there is no --density; give --integrators march");
  const bool usesVolume = !std::ranges::all_of(options.integrators, usesMap);
  for (const MapOption* option : volumeParameterization().options())
    unused.tellUnless(usesVolume, option->flag(), "march alone uses no shadow volume");
  unused.tellUnless(!flags.out.empty() && std::filesystem::path(flags.out).extension() != ".exr", "--exposure",
                    "it is of PNG pictures, which -o writes");
}

void tellLightsLeftOut(const Session& session) {
  if (session.setup().light != "all") return;
  const std::vector<Light> lights = chooseLights(session.setup(), session.tracer(), volumeParameterization());
  for (const Light& light : session.scene().lights)
    if (std::ranges::find(lights, light.name, &Light::name) == lights.end())
      fmt::print(stderr, "gnomon: note: light '{}' is left out: a medium is lit by lamps, which have a position\n",
                 light.name);
}

void tellStandingLights(const FogFlags& flags, const FogOptions& options, const Session& session) {
  if (!options.motion) return;
  for (const Light& light : lightsAsked(session.setup(), session.tracer()))
    if (orbitLeaves(*options.motion, light, session.tracer().boundsW()))
      fmt::print(stderr, "gnomon: note: --move {}: light '{}' is on the axis, and does not move\n", flags.move,
                 light.name);
}

// What a picture changes with other steps, which is about what it errs by where they are half as many.
void tellError(const FogResult& result) {
  if (result.rows.size() < 2 || result.reference || result.rows[0].integrator != result.rows[1].integrator) return;
  std::printf("with %d steps instead of %d the medium's light differs by %.2g of its mean (relative RMSE)\n",
              result.rows[1].steps.value_or(0), result.rows[0].steps.value_or(0),
              relativeRmse(result.inScattered[1], result.inScattered[0]));
}

// `show`: of fogPicturesToShow().
void writePicture(const std::filesystem::path& path, const std::string& show, const FogResult& result,
                  const ImageF& inScattered) {
  if (path.extension() == ".exr")
    writeFogExr(path, result.view, inScattered);
  else if (show == "medium")
    writePng(path, exposed(inScattered, result.mediumExposure));
  else
    writePng(path, exposed(composed(result.view, inScattered), result.exposure));
  say(fmt::format("wrote {}\n", path.string()));
}

int runFogVerb(const FogFlags& flags) {
  const bool toFolder = namesFolder(flags.out);
  if (toFolder)
    checkFolderName(flags.out,
                    "write .png or .exr for a picture; of --frames give a folder, where ffmpeg makes frames/*.mp4");
  if (isStream(flags.out) && flags.truth)
    throw UsageError(fmt::format("-o {}: --truth writes two pictures; name a file or a folder", flags.out));
  for (const std::string& file : {toFolder ? "" : flags.out, flags.json})
    if (!file.empty()) checkOutput(file);
  const InterruptGuard guard;  // before there is a folder that must not stay
  ResultFolder folder(toFolder ? flags.out : "", "results.json");
  const Session session = openSession(flags.scene);
  FogOptions options = fogOptions(flags, session.scene().originW);
  tellUnusedFlags(flags, options);
  tellLightsLeftOut(session);
  tellStandingLights(flags, options, session);
  options.outDir = folder.aside();
  FogResult result = runFog(session, options);
  result.files = folder.files();
  const std::string json = fogJson(session, options, result, commandLine());
  if (!options.outDir.empty()) {
    writeTextFile(options.outDir / "results.json", json);
    writeTextFile(options.outDir / "report.html", reportHtml(options.outDir));
    folder.publish();
  }
  if (!flags.json.empty()) writeTextFile(flags.json, json);
  say(fogTable(session, options, result));
  if (!options.outDir.empty()) {
    say(fmt::format("wrote {0}/report.html, results.json and pictures below {0}\n", flags.out));
  } else if (!flags.out.empty()) {
    const std::filesystem::path path = flags.out;
    writePicture(path, flags.show, result, result.inScattered.front());
    tellError(result);
    if (result.reference) {
      std::filesystem::path beside = path;
      beside.replace_filename(path.stem().string() + ".reference" + path.extension().string());
      writePicture(beside, flags.show, result, result.reference->inScattered);
    }
  }
  if (!result.isComplete) {
    const std::string done = options.motion
                                 ? fmt::format("{} of {} frames are done", result.framesDone, options.motion->frames)
                             : flags.truth && !result.reference ? std::string("there is no reference")
                                                                : std::string("all but the end is done");
    std::fprintf(stderr, "gnomon: interrupted: %s\n", done.c_str());
    return kInterruptedExitCode;
  }
  return 0;
}

void addMediumFlags(CLI::App& verb, FogFlags& flags) {
  verb.add_option("--sigma-s", flags.sigmaS,
                  "scattering coefficient, 1/m, one number or r,g,b; default: grey, an optical depth of one half "
                  "across the scene's diagonal");
  verb.add_option("--sigma-a", flags.sigmaA, "absorption coefficient, 1/m, one number or r,g,b")->capture_default_str();
  verb.add_option("--g", flags.g,
                  "asymmetry of the Henyey-Greenstein phase function (its mean cosine), between -1 and 1")
      ->capture_default_str();
  verb.add_option("--reach", flags.reach,
                  "metres from the eye at which view rays end if they hit no surface; default: the farthest corner "
                  "of the scene's bounds");
  offersFiles(verb.add_option(
      "--density", flags.density,
      "FILE.vdb[:grid], a float grid that multiplies sigma_s and sigma_a (`gnomon scene --density` "
      "generates some), or smoke.####.vdb, a file a frame, with --frames; default: none, a homogeneous medium"));
  verb.add_option("--density-at", flags.densityAt,
                  "x,y,z: new centre of the density, metres; default: where the file places it");
  verb.add_option("--density-scale", flags.densityScale, "scale factor of the density's size; default: 1");
  verb.add_option("--density-turn", flags.densityTurn,
                  "degrees about the density's centre and the y axis, counter-clockwise seen from above; default: 0");
  verb.add_option("--ambient", flags.ambient,
                  "ambient light: radiance of a white surface without any other light, cd/m^2")
      ->capture_default_str();
}

void addIntegrationFlags(CLI::App& verb, FogFlags& flags) {
  const OptionGroup group(verb, "Integration");
  verb.add_flag("--truth", flags.truth, "ray-trace the reference, and score each integrator against it");
  verb.add_option(
      "--bound", flags.bound,
      fmt::format("convergence tolerance of the reference: the most that doubling its samples may change a pixel, as "
                  "a fraction of the picture's mean; default: {:g}, in a density {:g}",
                  kBound, kDensityBound));
  verb.add_flag("--no-cache", flags.noCache, "neither read nor write the cache of references");
  std::vector<std::string> integratorNames;
  for (const Integrator& integrator : integrators()) integratorNames.emplace_back(integrator.name);
  offersSomeOf(verb.add_option("--integrators", flags.integrators, integratorsHelp()), integratorNames);
  verb.add_option("--steps", flags.steps,
                  fmt::format("samples along a view ray, for march; in a density, for every integrator; default: {}; "
                              "where only a picture is asked for: {}, the second to tell its error",
                              kComparedSteps, kPictureSteps));
  std::vector<std::string> maps;
  for (const Parameterization* map : parameterizations())
    if (map->looksAround()) maps.emplace_back(map->name());
  offersOneOf(
      verb.add_option("--march-map", flags.marchMap, "shadow map for march: " + marchMaps())->capture_default_str(),
      maps);
  addMapOptionFlags(verb, flags.map, volumeParameterization().options());
  verb.add_option("--map-size", flags.map.mapSize,
                  "side of the images of --march-map, and of the cube map of --vsv-source resample; texels")
      ->check(CLI::Range(2, 16384))
      ->capture_default_str();
  addCullFlag(verb, flags.map);
  verb.add_option("--repeats", flags.repeats,
                  fmt::format("repetitions of every timed stage; medians are reported; default: {}, where only a "
                              "picture is asked for {}",
                              kComparedRepeats, kPictureRepeats))
      ->check(CLI::Range(1, 1000));
}

Run addFog(CLI::App* verb) {
  auto flags = std::make_shared<FogFlags>();
  flags->verb = verb;
  addSceneFlags(*verb, flags->scene);
  addExposureFlag(*verb, flags->exposure);
  verb->get_option("--exposure")->group("View and device");
  {
    const OptionGroup group(*verb, "Output");
    offersFilesOrFolder(
        verb->add_option("-o,--out", flags->out,
                         "a picture by the first of --integrators, .exr (cd/m^2) or .png (exposed); or a folder for "
                         "report.html, results.json and all pictures"),
        namesFolder);
    offersOneOf(verb->add_option("--show", flags->show,
                                 "of a .png: surfaces and medium (beauty), or the medium alone at its own exposure")
                    ->check(oneOf(fogPicturesToShow()))
                    ->capture_default_str(),
                fogPicturesToShow());
    offersFiles(verb->add_option("--json", flags->json, "write results.json here"));
  }
  addIntegrationFlags(*verb, *flags);
  {
    const OptionGroup group(*verb, "Medium");
    addMediumFlags(*verb, *flags);
  }
  const OptionGroup group(*verb, "Motion");
  verb->add_option(
      "--frames", flags->frames,
      "number of frames along --move, or of a sequence of densities; with --truth, flicker is measured too");
  verb->add_option(
      "--move", flags->move,
      "light:x,y,z or camera:x,y,z: offset from the first frame to the last, metres; orbit:AXIS,DEGREES: the "
      "light goes round the scene's centre, AXIS x, y, z or a vector, as in orbit:y,360");
  verb->add_option("--first-frame", flags->firstFrame,
                   "number of a sequence's first file; default: the least that there is");
  return [flags] { return runFogVerb(*flags); };
}
}  // namespace

Verb fogVerb() {
  return {.name = "fog",
          .sentence =
              "renders light shafts in a medium; --truth scores each integrator against a ray-traced "
              "reference",
          .add = addFog};
}

}  // namespace gnomon
