#pragma once
// The rows of a store, as statistics need them: cases by number, methods by number.

#include "lab/store/store.h"

#include <string>
#include <vector>

namespace gnomon {

// What ranks methods. Through filters it is the RMSE, as in compare.
enum class ErrorBy { BiasError, AllWrong, Rmse };
const char* errorName(ErrorBy by);              // bias_error, all_wrong, rmse
ErrorBy parseErrorBy(const std::string& name);  // throws UsageError

struct CaseFilter {
  std::vector<std::string> scenes, maps;  // empty: all
  std::vector<int> sizes;
  std::optional<ErrorBy> by;  // absent: bias error; RMSE where some row is filtered
};

// One method in one case.
struct MeasuredCase {
  size_t method = 0, scene = 0, view = 0, map = 0, size = 0;  // among the names of the table; views of all scenes
  double error = 0.0, biasError = 0.0, allWrong = 0.0;
  size_t texels = 0;
  std::optional<double> buildMs, shadeMs, frameMs;
  std::string key;
};

struct CaseTable {
  std::string name;  // of the plan
  ErrorBy by = ErrorBy::BiasError;
  std::vector<std::string> methods, scenes, maps;
  std::vector<int> sizes;
  std::vector<std::string> views;  // "atrium: front, lantern"
  std::vector<MeasuredCase> cases;
  std::vector<std::string> programs, devices, machines;
  size_t superseded = 0, empty = 0, failed = 0;
  size_t media = 0;  // rows of media, which are not among the cases
};

// Throws WorldError where nothing is left.
CaseTable measuredCases(const Store& store, const CaseFilter& filter);

}  // namespace gnomon
