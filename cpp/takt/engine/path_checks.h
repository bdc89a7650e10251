// Answers groups that ask whether a path is free (group/path_check_request.h), with what stands in their workspaces,
// and has tracks made (track/build_queues.h) and cams built (cam/builder.h). Not for the cycle.
//
// Simulated time asks between two cycles, so that it stands still meanwhile and each run is the same; real time has a
// thread for it. The answer is a command of the journal: a replay asks nobody.
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
  // `checkers`: of LoadMachine. `engine` must outlive this.
  PathChecks(Engine& engine, Checkers checkers);
  ~PathChecks();

  // Answers what has been asked. One thread.
  void Run();

  // What is wrong, for people: of a path that was refused, what meets what where. Any thread. Empty: nothing is.
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

// What is wrong, for people, where nobody has looked at the workspace; empty: nothing is. The machine has names for
// what is in the way.
std::string Sentence(const FeedbackEvent& event);
std::string SentenceNaming(const FeedbackEvent& event, const Machine& machine);

// Runs them again and again, for as long as this lives.
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
