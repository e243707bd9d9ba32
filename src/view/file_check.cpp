#include "view/file_check.h"

#include "base/file.h"
#include "shadow/user_bias_check.h"
#include "view/view_controls.h"

#include <atomic>
#include <exception>
#include <system_error>
#include <thread>

namespace gnomon {

namespace {

constexpr uint64_t kMostOfSession = 1 << 20;

void check(const std::string& path, const ViewState& state) {
  if (path.ends_with(".glsl"))
    checkUserBias(*loadUserBias(path));
  else
    readSession(path, readSessionFile(path), state);
}

}  // namespace

struct FileCheck::Outcome {
  std::atomic<bool> isDone = false;
  std::exception_ptr problem;
};

bool FileCheck::isFor(const std::string& path) {
  return path.ends_with(".glsl") || path.ends_with(".json");
}

FileCheck::FileCheck(const std::string& path, const ViewState& state) : outcome_(std::make_shared<Outcome>()) {
  const auto work = [path, state, outcome = outcome_] {
    try {
      check(path, state);
    } catch (...) {
      outcome->problem = std::current_exception();
    }
    outcome->isDone = true;
  };
  try {
    std::thread(work).detach();
  } catch (const std::system_error&) {  // there are too many
    work();
  }
}

bool FileCheck::isDone() const {
  return outcome_->isDone;
}

void FileCheck::rethrow() const {
  if (outcome_->problem) std::rethrow_exception(outcome_->problem);
}

std::string readSessionFile(const std::string& path) {
  return readFile(path, kMostOfSession);
}

}  // namespace gnomon
