#pragma once
// What passes between the window's thread and the solver's: orders that wait, and the newest of what was found. Every
// function returns at once, but for the solver's own waiting.
#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <utility>

#include "solver.hpp"

namespace deltalux::viewer {

/// A picture that is to be made better.
struct Look {
  View view;
  int width = 0, height = 0;
  std::vector<char> first;
};

/// What the window wants and the solver has not taken up yet.
struct Orders {
  std::vector<Edit> edits;
  std::uint64_t editCount = 0;  // of all edits so far
  std::optional<bool> moving;   // whether more edits follow: said with the last of them
  std::optional<std::string> select;
  std::optional<std::optional<Look>> look;
  std::optional<std::vector<PixelRay>> rays;
  std::optional<std::vector<ProbePoint>> meters;
  std::uint64_t pinned = 0;  // how often there were others
  struct Question {
    std::uint64_t number = 0;
    ProbePoint point;
    std::optional<Vec3> eye;
  };
  std::optional<Question> question;
  struct Save {
    std::string file;
    std::function<void(std::string)> written;
  };
  std::vector<Save> saves;
  struct Measurement {
    std::vector<ProbePoint> points;
    std::promise<std::vector<ProbeResult>> results;
  };
  std::vector<Measurement> measurements;
};

class SolverInbox {
 public:
  /// Puts something in: `change` gets the orders, and what it returns comes back.
  template <class Change>
  auto put(const Change& change) {
    const std::lock_guard lock(mutex_);
    filled_ = true;
    wake_.notify_one();
    return change(orders_);
  }
  /// Takes all that is there, as soon as there is something, or when so much time has passed [s]. Counters stay.
  Orders take(double patience);
  bool filled() const { return filled_; }
  void stop();
  bool stopped() const { return stopped_; }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  Orders orders_;
  std::atomic<bool> filled_ = false, stopped_ = false;
};

/// What the solver has found: the newest of each.
struct Findings {
  Status status;
  std::shared_ptr<const SolutionMesh> mesh;
  std::shared_ptr<const SampleChanges> changes;
  std::shared_ptr<const Picture> picture;
  std::shared_ptr<const Readings> readings;
  std::shared_ptr<const Answer> answer;
  std::vector<PixelSample> samples;  // not taken yet
};

class SolverOutbox {
 public:
  /// Changes what there is to find, and tells that there is something new.
  template <class Change>
  void publish(const Change& change) {
    std::function<void()> tell;
    {
      const std::lock_guard lock(mutex_);
      change(findings_);
      tell = tell_;
    }
    if (tell) tell();
  }
  template <class Read>
  auto read(const Read& read) const {
    const std::lock_guard lock(mutex_);
    return read(findings_);
  }
  std::vector<PixelSample> takeSamples();
  void onChange(std::function<void()>);

 private:
  mutable std::mutex mutex_;
  Findings findings_;
  std::function<void()> tell_;
};

}  // namespace deltalux::viewer
