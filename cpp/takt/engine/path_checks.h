// Answers groups that ask whether a path is free (group/path_check_request.h), from the obstacles in their workspaces,
// and builds tracks (track/build_queues.h) and cams (cam/builder.h). Not for use within the cycle.
//
// In simulated time this runs between two cycles, so that time stands still meanwhile and every run is the same; in
// real time it has a thread of its own. The answer is a command of the journal: a replay needs no checks.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "takt/core/feedback.h"
#include "takt/engine/checkers.h"
#include "takt/engine/engine.h"

namespace takt::engine {

class PathChecks {
 public:
  // `checkers`: from LoadMachine. `engine` must outlive this object.
  PathChecks(Engine& engine, Checkers checkers);
  ~PathChecks();

  // Answers all waiting requests. Call from one thread.
  void Run();

  // Returns a message for users, e.g. which objects collide where on a refused path; empty if there is no error. Any
  // thread.
  std::string Sentence(const FeedbackEvent& event);

 private:
  struct OfGroup;

  group::PathChecked Check(const group::PathCheckRequest& question);
  void Remember(Ticket ticket, std::string sentence);

  Engine& engine_;
  std::vector<std::unique_ptr<OfGroup>> groups_;
  std::mutex mutex_;
  std::deque<std::pair<Ticket, std::string>> sentences_;
};

// Returns a message for users without a check of the workspace; empty if there is no error. SentenceNaming also names
// the objects involved, by their names in the machine.
std::string Sentence(const FeedbackEvent& event);
std::string SentenceNaming(const FeedbackEvent& event, const Machine& machine);

// Runs the checks repeatedly while this object lives.
class PathCheckThread {
 public:
  explicit PathCheckThread(PathChecks& checks);
  ~PathCheckThread();
  PathCheckThread(const PathCheckThread&) = delete;
  PathCheckThread& operator=(const PathCheckThread&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace takt::engine
