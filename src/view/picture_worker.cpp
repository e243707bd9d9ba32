#include "view/picture_worker.h"

#include "base/error.h"
#include "base/process_memory.h"
#include "view/picture_studio.h"

#include <chrono>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

PictureWorker::PictureWorker(const gpu::DeviceOptions& device, std::function<void()> onPicture)
    : device_(device), onPicture_(std::move(onPicture)), thread_([this] { run(); }) {}

PictureWorker::~PictureWorker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void PictureWorker::ask(PictureRequest request) {
  {
    const std::lock_guard lock(mutex_);
    asked_ = std::move(request);
  }
  wake_.notify_all();
}

std::shared_ptr<const ViewPicture> PictureWorker::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

bool PictureWorker::isIdle() const {
  const std::lock_guard lock(mutex_);
  return !busy_ && !asked_;
}

bool PictureWorker::isReady() const {
  const std::lock_guard lock(mutex_);
  return !busy_ && !asked_ && !prepares_;
}

size_t PictureWorker::validationMessages() const {
  const std::lock_guard lock(mutex_);
  return validationMessages_;
}

void PictureWorker::loseDevice() {
  const std::lock_guard lock(mutex_);
  loses_ = true;
}

void PictureWorker::run() {
  std::unique_ptr<PictureStudio> studio;
  size_t forgotten = 0;  // messages of devices before
  const auto forget = [&] {
    if (studio) forgotten += studio->device().validationMessages().size();
    studio.reset();
  };
  const auto publish = [&](std::shared_ptr<const ViewPicture> picture) {
    {
      const std::lock_guard lock(mutex_);
      newest_ = std::move(picture);
      if (studio) validationMessages_ = forgotten + studio->device().validationMessages().size();
    }
    onPicture_();
  };
  const auto overtaken = [&] {
    const std::lock_guard lock(mutex_);
    return asked_.has_value() || ends_;
  };
  FreedMemory freed;
  // While the window is being made; what is wrong is told with the first picture.
  try {
    studio = std::make_unique<PictureStudio>(device_);
  } catch (const std::exception&) {
  }
  while (true) {
    freed.giveBackNowAndThen();
    PictureRequest request;
    {
      std::unique_lock lock(mutex_);
      busy_ = prepares_ = false;
      wake_.wait(lock, [&] { return asked_ || ends_; });
      if (ends_) return;
      request = std::move(*asked_);
      asked_.reset();
      busy_ = true;
      if (loses_) forget();
      loses_ = false;
    }
    // What went wrong, over the last good picture.
    const auto complain = [&](const std::string& problem, bool ofScene) {
      const std::shared_ptr<const ViewPicture> last = newest();
      auto picture = last ? std::make_shared<ViewPicture>(*last) : std::make_shared<ViewPicture>();
      picture->number = request.number;
      picture->problem = problem;
      picture->sceneFailed = ofScene;
      picture->refined = true;
      publish(picture);
    };
    // Nothing is left to do; time for what nobody waits for.
    const auto rest = [&] {
      {
        const std::lock_guard lock(mutex_);
        busy_ = false;
        prepares_ = true;
      }
      if (overtaken()) return;
      try {
        studio->rehearse(request, overtaken);
      } catch (const std::exception&) {
        // It is told when it is drawn.
      }
    };
    bool inScene = true;
    try {
      if (!studio) studio = std::make_unique<PictureStudio>(device_);
      const Clock::time_point start = Clock::now();
      studio->openScene(request.state);
      inScene = false;
      chooseMapsByLight(request.state, studio->tracer());
      std::shared_ptr<ViewPicture> picture = studio->draw(request);
      picture->stages.push_back({"all", msSince(start)});
      const bool wantsReference = PictureStudio::wantsReference(request.state);
      picture->refined = false;
      publish(picture);
      if (request.moving || overtaken()) continue;
      if (PictureStudio::needsEstimate(request, *picture)) {
        picture = std::make_shared<ViewPicture>(*picture);
        studio->estimate(request, *picture);
        publish(picture);
        if (overtaken()) continue;
      }
      auto refined = std::make_shared<ViewPicture>(*picture);
      if (!studio->refine(request, *refined, overtaken)) continue;
      refined->stages.push_back({"labels", msSince(start) - picture->stages.back().ms});
      refined->refined = !wantsReference;
      publish(refined);
      if (!wantsReference) {
        rest();
        continue;
      }
      if (overtaken()) continue;
      auto exact = std::make_shared<ViewPicture>(*refined);
      studio->traceReference(request, *exact);
      exact->refined = true;
      publish(exact);
      rest();
    } catch (const std::bad_alloc&) {
      complain("out of memory; take a smaller picture or map", inScene);
    } catch (const std::exception& error) {
      complain(error.what(), inScene);
      // Nothing made on a device that is lost is worth keeping; the next picture makes all anew.
      if (std::string(error.what()).find("VK_ERROR_DEVICE_LOST") != std::string::npos) forget();
    }
  }
}

}  // namespace gnomon
