#pragma once
// One view of a sweep: a light as a camera sees it, on each of the plan's maps, by each of its methods.

#include "lab/sweep/sweep.h"

#include <chrono>

namespace gnomon {

class StageClock {
 public:
  // Adds what passes until it ends.
  class Running {
   public:
    Running(StageClock& clock, std::string stage) : clock_(clock), stage_(std::move(stage)) {}
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

   private:
    StageClock& clock_;
    std::string stage_;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  };
  Running run(const std::string& stage) { return Running(*this, stage); }
  Stages stages() const;  // the longest first

 private:
  std::map<std::string, double> seconds_;
};

// A row that a plan asks for.
struct WantedRow {
  size_t method = 0, filter = 0;  // among the axes'
  std::string key, slot;
};

struct WantedMedium {
  size_t method = 0;  // among the medium's
  std::string key, slot;
};

// A light on a map of one size, with the rows that are asked for.
struct WantedCase {
  size_t map = 0;     // among the axes'
  StoredCase stored;  // what is known before it is measured
  std::vector<WantedRow> rows;
};

struct WantedMedia {
  size_t medium = 0;
  StoredCase stored;
  std::vector<WantedMedium> rows;
};

// All cases of a view, and a key of the whole.
struct WantedView {
  std::string key;
  std::vector<WantedCase> cases;
  std::vector<WantedMedia> media;
  size_t rowCount() const;
};

// `device`: the name and driver of the one that measures.
WantedView wantedOf(const Plan& plan, const Axes& axes, const Survey& survey, const SweepView& view,
                    const Machine& machine);
// What of a view is not in the store.
WantedView missingOf(const WantedView& wanted, Store& store);
// This process, as it measures.
Machine machineOf(const gpu::Device& device, const SweepOptions& options);

// Measures views one after another; neighbours share what they can.
class SweepMeasurer {
 public:
  SweepMeasurer(const Plan& plan, const Axes& axes, const Survey& survey, std::shared_ptr<const gpu::Device> device,
                StageClock& clock);
  ~SweepMeasurer();

  // From now on of this view.
  void enter(const SweepView& view);
  // Nothing where no pixel faces the light; then `of` says so. `leastOfWorst`: of a method, the bias error from which
  // on a case's worst place is worth a picture; empty: none is. Throws Interrupted, WorldError.
  struct Measured {
    StoredCase of;
    std::vector<StoredRow> rows;
  };
  std::optional<Measured> measure(const WantedCase& wanted,
                                  const std::function<double(const std::string&)>& leastOfWorst);
  std::vector<StoredMedium> measureMedia(const WantedMedia& wanted);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gnomon
