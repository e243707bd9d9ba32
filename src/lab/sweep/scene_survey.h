#pragma once
// What a survey finds of one scene, as a text in a store's notes: a sweep that goes on opens only the scenes that it
// still measures.

#include "lab/store/store.h"
#include "lab/sweep/survey.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

struct SceneSurvey {
  SurveyedScene scene;
  std::set<std::string> found;                               // places of the plan whose names it has
  std::vector<std::pair<std::string, std::string>> missing;  // places whose names it lacks, with the complaint
};

// A key of all that the plan says about a scene and its lights and cameras.
std::string surveyKey(const Plan& plan, const Axes& axes, const SweepScene& scene);

// Nothing where it is not known, another program found it, or a file has changed since. `scene.at` and `scene.traced`
// are not among what is known.
// `source`: the scene's name or file.
std::optional<SceneSurvey> knownSurvey(const Store& store, const std::string& key, const std::string& program,
                                       const std::string& source);
void keepSurvey(Store& store, const std::string& key, const std::string& program, const std::string& source,
                const SceneSurvey& survey);

// A glTF file and what it refers to by URIs; of a generated scene nothing.
std::vector<std::filesystem::path> filesOfScene(const std::string& source);

}  // namespace gnomon
