#include "cli/choice.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/verbs.h"
#include "cli/view_flags.h"
#include "lab/compare/render_picture.h"

#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

Run addView(CLI::App* verb) {
  auto flags = std::make_shared<ViewFlags>();
  flags->scene.setup.scene = "atrium";
  addSceneFlags(*verb, flags->scene);
  verb->get_option("SCENE")->required(false)->default_str("atrium");
  addMethodFlags(*verb, flags->method, kDefaultBias, "one, or A,B to compare", "one, or A,B to compare");
  addExposureFlag(*verb, flags->method.map.exposure);
  const CLI::Option* biases = verb->get_option("--biases");
  verb->get_option("--exposure")->group("View and device");
  const OptionGroup group(*verb, "Window");
  offersOneOf(verb->add_option("--show", flags->show, "which picture to begin with; keys 1 to 5 and the menu change it")
                  ->check(oneOf(picturesToShow()))
                  ->capture_default_str(),
              picturesToShow());
  offersFiles(
      verb->add_option("--session", flags->session,
                       "a session that was saved (Ctrl+S saves there): begins with it where the file is there"));
  offersFiles(verb->add_option("--script", flags->script,
                               "plays inputs from a file, a line each, and ends (docs/view.md lists the verbs)"));
  verb->add_option("--frames", flags->frames, "ends after so many frames, when nothing is left to draw")
      ->check(CLI::Range(1, 1000000));
  offersFiles(verb->add_option("--screenshot", flags->screenshot, "at the end, writes the whole window to this PNG"));
  offersFiles(
      verb->add_option("--picture", flags->picture, "at the end, writes the picture of A as `gnomon render` does"));
  offersFiles(verb->add_option("--json", flags->json, "at the end, writes what was measured: times, latency"));
  verb->add_option("--window", flags->window, "size of the window, WxH pixels")
      ->check([](const std::string& text) {
        return text.find('x') != std::string::npos ? "" : fmt::format("{}: write WxH, as in 1280x800", text);
      })
      ->capture_default_str();
  verb->add_option("--ui-scale", flags->scale, "of text and controls; default: the display's")->check(within(0.5, 4.0));
  return [flags, biases] {
    flags->biasIsGiven = biases->count() > 0;
    return openWindow(*flags);
  };
}

}  // namespace

Verb viewVerb() {
  return {
      .name = "view", .sentence = "opens a window: maps, biases and fog while light and camera move", .add = addView};
}

}  // namespace gnomon
