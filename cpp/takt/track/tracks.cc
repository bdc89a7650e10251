#include "takt/track/tracks.h"

#include <algorithm>
#include <utility>

#include "takt/core/hash.h"
#include "takt/core/in_range.h"
#include "takt/track/build.h"
#include "takt/track/on_parts.h"
#include "takt/track/pending_edits.h"

namespace takt::track {

namespace {

using planar::ObjectState;

const planar::Parts kNoParts;
const planar::Spot kOrigin;

void Enter(const Context& c, ObjectState state, State& s) {
  s.state = state;
  s.since = c.cycle.count;
}

void Finish(const Context& c, State& s, FeedbackState end) {
  if (s.ticket != 0) c.feedback.Report({s.ticket, c.cycle.count, end, false, ErrorId::kNone, 0});
  s.ticket = 0;
}

// Ends enabling: with success, or with an error if the track has no length.
void EndEnabling(const Context& c, State& s) {
  if (s.has_length) {
    Enter(c, ObjectState::kEnabled, s);
    s.mode = OperationMode::kStanding;
    return Finish(c, s, FeedbackState::kDone);
  }
  Enter(c, ObjectState::kDisabling, s);
  c.feedback.Report({s.ticket, c.cycle.count, FeedbackState::kError, false, ErrorId::kTrackGeometry,
                     ToValue(planar::Problem::kEmpty, 0)});
  s.ticket = 0;
}

void StepOne(const Context& c, std::uint32_t track, State& s) {
  if (s.since >= c.cycle.count) return;  // each state lasts at least one cycle
  switch (s.state) {
    case ObjectState::kEnabling:
      if (!HasPendingEdit(c.tracks.works, track)) EndEnabling(c, s);
      break;
    case ObjectState::kDisabling:
      Enter(c, ObjectState::kDisabled, s);
      s.mode = OperationMode::kUninitialized;
      Finish(c, s, FeedbackState::kDone);
      break;
    case ObjectState::kErrorPending:
      Enter(c, ObjectState::kError, s);
      break;
    case ObjectState::kResetting: {
      const bool enabled = s.reaction == ErrorReaction::kQuickStop && s.has_length;
      Enter(c, enabled ? ObjectState::kEnabled : ObjectState::kDisabled, s);
      s.mode = enabled ? OperationMode::kStanding : OperationMode::kUninitialized;
      s.error = ErrorId::kNone;
      Finish(c, s, FeedbackState::kDone);
      break;
    }
    case ObjectState::kDisabled:
    case ObjectState::kEnabled:
    case ObjectState::kError:
      break;
  }
}

// One command to one track.
struct Applier {
  const Context& c;
  std::uint32_t track;
  Ticket ticket;
  State& s;

  void Report(FeedbackState state, ErrorId error = ErrorId::kNone, double value = 0) const {
    c.feedback.Report({ticket, c.cycle.count, state, false, error, value});
  }
  void Refuse(ErrorId error) const { Report(FeedbackState::kError, error); }
  void RefuseInUse() const {
    const ObjectInfo mover = ObjectAt(ObjectKind::kMover, c.tracks.usages[track].one);
    c.feedback.Report({ticket, c.cycle.count, FeedbackState::kError, false, ErrorId::kTrackMode, 0, mover});
  }
  void Refuse(planar::Problem problem) const {
    Report(FeedbackState::kError, ErrorId::kTrackGeometry, ToValue(problem, 0));
  }
  void DoneAtOnce() const {
    Report(FeedbackState::kActive);
    Report(FeedbackState::kDone);
  }
  // Enters a state. The pending command is aborted, also if it is of the same kind.
  void Become(ObjectState state) const {
    Finish(c, s, FeedbackState::kAborted);
    if (s.state != state) Enter(c, state, s);
    s.ticket = ticket;
    Report(FeedbackState::kActive);
  }

  void ToWorks(Order order) const {
    if (s.state != ObjectState::kDisabled) return Refuse(planar::Problem::kNotDisabled);
    if (c.tracks.usages[track].movers > 0) return RefuseInUse();
    order.ticket = ticket;
    order.track = track;
    if (!Put(order, c.tracks.works)) Refuse(planar::Problem::kBusy);
  }
  // Appends an element; its coordinates, of this reference, become those of the track's part.
  void Append(const Name& reference, planar::Element element) const {
    const planar::Parts& parts = c.tracks.parts;
    const std::uint32_t part = c.tracks.part_of[track];
    const bool own = part != planar::kNoPart && parts.all[part].name == reference.view();
    if (!own) {
      const std::optional<planar::Spot> from = planar::Resolve(parts, reference.view());
      const std::optional<planar::Spot> to = SpotOf(parts, {.part = part});
      if (!from || !to || from->system != to->system) return Refuse(ErrorId::kReference);
      for (planar::Place* place : {&element.start, &element.end, &element.center}) {
        *place = *place + from->origin - to->origin;
      }
    }
    ToWorks({.kind = OrderKind::kAppend, .element = element});
  }
  template <typename LinkCommand>
  void Link(OrderKind kind, const LinkCommand& a) const {
    const std::optional<std::size_t> other = Find(c.tracks, a.track.view());
    if (!other || *other == track) return Refuse(ErrorId::kParameter);
    ToWorks({.kind = kind,
             .element = {},
             .other = static_cast<std::uint32_t>(*other),
             .own_position = a.this_position_index,
             .other_position = a.other_position_index,
             .only_there = a.only_there});
  }

  void operator()(const AppendLine& a) const {
    Append(a.reference,
           {.shape = planar::ElementShape::kLine, .start = {a.start_x, a.start_y}, .end = {a.end_x, a.end_y}});
  }
  void operator()(const AppendCircle& a) const {
    Append(a.reference, {.shape = planar::ElementShape::kArc,
                         .start = {a.start_x, a.start_y},
                         .end = {a.end_x, a.end_y},
                         .center = {a.center_x, a.center_y},
                         .clockwise = a.clockwise});
  }
  void operator()(const AppendPosition& a) const {
    Append(a.reference, {.shape = planar::ElementShape::kPosition, .start = {}, .end = {a.x, a.y}});
  }
  void operator()(const CloseLoop&) const { ToWorks({.kind = OrderKind::kCloseLoop, .element = {}}); }
  void operator()(const Clear&) const { ToWorks({.kind = OrderKind::kClear, .element = {}}); }
  void operator()(const StartFromTrack& a) const { Link(OrderKind::kStartFrom, a); }
  void operator()(const EndAtTrack& a) const { Link(OrderKind::kEndAt, a); }

  void operator()(const Enable&) const {
    switch (s.state) {
      case ObjectState::kDisabled:
      case ObjectState::kDisabling:
      case ObjectState::kEnabling:
        return Become(ObjectState::kEnabling);
      case ObjectState::kEnabled:
        return DoneAtOnce();
      default:
        return Refuse(ErrorId::kState);
    }
  }
  void operator()(const Disable&) const {
    switch (s.state) {
      case ObjectState::kEnabled:
        if (s.mode != OperationMode::kStanding) return RefuseInUse();
        return Become(ObjectState::kDisabling);
      case ObjectState::kEnabling:
      case ObjectState::kDisabling:
        return Become(ObjectState::kDisabling);
      case ObjectState::kDisabled:
        return DoneAtOnce();
      default:  // after a fault
        s.reaction = ErrorReaction::kAbort;
        return DoneAtOnce();
    }
  }
  void operator()(const Reset&) const {
    if (s.state == ObjectState::kErrorPending) return Refuse(ErrorId::kState);
    if (s.state != ObjectState::kError && s.state != ObjectState::kResetting) return DoneAtOnce();
    Become(ObjectState::kResetting);
  }
  void Answer(const planar::Verdict& verdict) const {
    if (verdict.error == ErrorId::kNone) return DoneAtOnce();
    c.feedback.Report({ticket, c.cycle.count, FeedbackState::kError, false, verdict.error, 0, verdict.object});
  }
  void operator()(const AddToGroup& a) const {
    const std::uint32_t group = c.grounds.Find(a.group.view());
    if (group == 0) return Refuse(ErrorId::kParameter);
    Answer(planar::AddTrack(track, group, c.grounds));
  }
  void operator()(const RemoveFromGroup&) const { Answer(planar::RemoveTrack(track, c.grounds)); }
  void operator()(const TrackMade& made) const {
    if (!TakeAnswer(c, track, made)) return Refuse(ErrorId::kState);
    DoneAtOnce();
  }
};

}  // namespace

Tracks::Tracks(const std::vector<TrackParams>& all, const planar::Parts* on)
    : params(all),
      parts(on ? *on : kNoParts),
      states(all.size()),
      sketches(all.size()),
      outputs(all.size()),
      ways(all.size()),
      areas(all.size()),
      start_nodes(all.size()),
      end_nodes(all.size()),
      starts_at(2 * all.size()),
      ends_at(2 * all.size()),
      reached(all.size()),
      usages(all.size()),
      desk(all.size(), parts) {
  for (const TrackParams& p : all) part_of.push_back(PartOf(p, parts));
  BuildResult built = Build(all, &parts);
  for (std::size_t i = 0; i < all.size(); ++i) {
    State& s = states[i];
    SetSketch(i, ToSketch(built.tracks[i].layout));
    const auto link = [this](const std::vector<LinkParams>& all, Links& links) {
      for (const LinkParams& one : all) {
        links.tracks[links.count] = static_cast<std::uint32_t>(Find(*this, one.track).value());
        links.own_positions[links.count] = one.only_there ? one.this_position_index : 0;
        links.other_positions[links.count++] = one.only_there ? one.other_position_index : 0;
      }
    };
    link(LinksOf(all[i].starts_from, all[i].starts_from_positions), s.starts_from);
    link(LinksOf(all[i].ends_at, all[i].ends_at_positions), s.ends_at);
    if (!built.tracks[i].way) continue;
    ways[i] = new planar::Track(std::move(*built.tracks[i].way));
    areas[i] = new planar::TrackArea(planar::MakeTrackArea(*ways[i], LargestOn(all[i]), 0));
    s.has_length = true;
    s.length = ways[i]->length;
  }
  MakeNodes(*this);
}

void Tracks::SetSketch(std::size_t track, const Sketch& sketch) noexcept {
  sketches[track] = sketch;
  states[track].sketch_hash = HashOf(sketch, 0);
}

Tracks::~Tracks() {
  for (const planar::Track* way : ways) delete way;
  for (const planar::TrackArea* area : areas) delete area;
}

const planar::Spot& Tracks::spot(std::size_t track) const noexcept {
  return part_of[track] == planar::kNoPart ? kOrigin : parts.spot(part_of[track]);
}

const planar::Spot& Tracks::goal(std::size_t track) const noexcept {
  return part_of[track] == planar::kNoPart ? kOrigin : parts.goal(part_of[track]);
}

planar::TrackPoint Tracks::At(std::size_t track, double s) const noexcept {
  planar::TrackPoint point = planar::At(*ways[track], s);
  point.place = point.place + spot(track).origin;
  return point;
}

std::optional<std::size_t> Find(const Tracks& tracks, std::string_view name) noexcept {
  const auto found = std::ranges::find(tracks.params, name, &TrackParams::name);
  if (found == tracks.params.end()) return std::nullopt;
  return static_cast<std::size_t>(found - tracks.params.begin());
}

void Apply(const Context& c, std::size_t track, Ticket ticket, const Command& command) noexcept {
  const Applier applier{c, static_cast<std::uint32_t>(track), ticket, c.tracks.states[track]};
  std::visit([&](const auto& body) { takt::InRange(body) ? applier(body) : applier.Refuse(ErrorId::kParameter); },
             command);
}

void Fail(const Context& c, std::size_t track, ErrorId error, ErrorReaction reaction) noexcept {
  State& s = c.tracks.states[track];
  if (s.state == ObjectState::kResetting || s.state == ObjectState::kErrorPending) return;
  if (s.ticket != 0) c.feedback.Report({s.ticket, c.cycle.count, FeedbackState::kAborted, false, error, 0});
  s.ticket = 0;
  s.error = error;
  s.reaction = reaction;
  Enter(c, ObjectState::kErrorPending, s);
}

void Use(const Usage& usage, std::size_t track, Tracks& tracks) noexcept {
  tracks.usages[track] = usage;
  State& s = tracks.states[track];
  if (s.state != ObjectState::kEnabled) return;
  s.mode = usage.moves        ? OperationMode::kMoving
           : usage.configures ? OperationMode::kConfiguring
                              : OperationMode::kStanding;
}

void Step(const Context& c) noexcept {
  StepPendingEdits(c);
  for (std::uint32_t i = 0; i < c.tracks.states.size(); ++i) StepOne(c, i, c.tracks.states[i]);
}

void Publish(const Context& c) noexcept {
  const Tracks& t = c.tracks;
  for (std::size_t i = 0; i < t.states.size(); ++i) {
    const State& s = t.states[i];
    Outputs& out = c.tracks.outputs[i];
    out.state = s.state;
    out.operation_mode = s.mode;
    out.error = s.error;
    out.length = s.length;
    out.closed_loop = t.sketches[i].closed;
    out.element_count = t.sketches[i].count;
    out.mover_count = t.usages[i].movers;
    out.previous_tracks = t.ends_at[t.start_nodes[i]];
    out.subsequent_tracks = t.starts_at[t.end_nodes[i]];
    out.group = c.grounds.group_of_track[i];
  }
}

}  // namespace takt::track
