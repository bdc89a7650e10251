// Tracks in virtual time, with a builder for their requests.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "takt/track/tracks.h"

namespace takt::track {

class Rig {
 public:
  explicit Rig(std::size_t count)
      : tracks(Named(count)), grounds(0, count, 0, {}), storage(2 * EventsOf(count) + 256), feedback(storage) {}

  static std::vector<TrackParams> Named(std::size_t count) {
    std::vector<TrackParams> params(count);
    for (std::size_t i = 0; i < count; ++i) params[i].name = NameOf(i);
    return params;
  }
  static std::string NameOf(std::size_t i) { return "t" + std::to_string(i); }

  Context context() { return {tracks, grounds, cycle, feedback}; }

  // Returns the ticket. The command is carried out in the next cycle's stage of commands.
  Ticket Give(std::size_t track, const Command& command) {
    const Ticket ticket = next_++;
    Apply(context(), track, ticket, command);
    return ticket;
  }
  void Step() {
    track::Step(context());
    Publish(context());
    for (const FeedbackEvent& event : feedback.events()) {
      if (IsFinal(event.state)) {
        ++ends[event.ticket];
        last[event.ticket] = event;
      }
    }
    feedback.Clear();
    ++cycle.count;
  }
  // Requests are built between two cycles.
  void Work() {
    while (const std::optional<BuiltTrack> answer = Make(tracks.desk)) Apply(context(), answer->track, 0, answer->made);
  }
  void Steps(int count) {
    for (int i = 0; i < count; ++i) {
      Step();
      Work();
    }
  }
  // Steps until it has ended. Returns the problem for which it was refused, or kNone.
  planar::Problem End(Ticket ticket) {
    for (int i = 0; i < 500 && ends[ticket] == 0; ++i) Steps(1);
    return last[ticket].error == ErrorId::kTrackGeometry ? ProblemOf(last[ticket].value) : planar::Problem::kNone;
  }
  planar::Problem Do(std::size_t track, const Command& command) { return End(Give(track, command)); }
  const State& state(std::size_t track) const { return tracks.states[track]; }

  Tracks tracks;
  planar::GroupRegistry grounds;
  Cycle cycle{1, 0.001};
  std::vector<FeedbackEvent> storage;
  FeedbackSink feedback;
  std::map<Ticket, int> ends;  // number of ends of each command
  std::map<Ticket, FeedbackEvent> last;

 private:
  Ticket next_ = 1;
};

}  // namespace takt::track
