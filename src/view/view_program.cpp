// gnomon-view: the program gnomon with one verb, whose window is here.

#include "base/error.h"
#include "cli/verbs.h"
#include "cli/view_flags.h"
#include "view/view_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

Verb viewVerb();

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all = {viewVerb()};
  return all;
}

int openWindow(const ViewFlags& flags) {
  refuseAllLights(flags.scene, "view");
  CompareOptions options = compareOptions(flags.method);
  if (!flags.biasIsGiven && !options.userBiases.empty())
    options.biases.erase(options.biases.begin());  // a file given is the bias meant, not the default
  if (options.maps.size() > 2 || options.biases.size() > 2 || options.filters.size() > 2)
    throw UsageError(
        "view shows two pictures: give at most two --maps, biases (--biases, --bias-file) and --filters, for A and for "
        "B");
  ViewOptions view{.state = {.setup = flags.scene.setup},
                   .device = flags.scene.device,
                   .session = flags.session,
                   .script = flags.script,
                   .screenshot = flags.screenshot,
                   .picture = flags.picture,
                   .json = flags.json,
                   .frames = flags.frames,
                   .scale = flags.scale};
  view.namesOthers =
      flags.biasIsGiven || !options.userBiases.empty() || flags.method.verb->get_option("SCENE")->count() > 0;
  parseSize(flags.scene.setup.size);
  const PictureSize window = parseSize(flags.window, 0.0, "--window");
  view.width = window.width;
  view.height = window.height;
  // The first of two is A's, the second B's.
  for (size_t side = 0; side < kSideCount; ++side) {
    const auto pick = [&](const auto& list) { return std::vector{list[std::min(side, list.size() - 1)]}; };
    ViewSide& own = view.state.sides[side];
    own.options = options;
    own.options.maps = pick(options.maps);
    own.options.biases = pick(options.biases);
    own.options.filters = pick(options.filters);
    own.mapByLight = flags.method.map.maps.empty();
    own.show = flags.show;
    settleOnMap(own.options);
  }
  view.state.split = options.maps.size() > 1 || options.biases.size() > 1 || options.filters.size() > 1;
  return runWindow(view);
}

}  // namespace gnomon
