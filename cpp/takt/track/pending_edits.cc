#include "takt/track/pending_edits.h"

#include <algorithm>
#include <span>
#include <utility>

#include "takt/planar/network.h"
#include "takt/track/on_parts.h"

namespace takt::track {

namespace {

using planar::Problem;

std::span<const std::uint32_t> All(const Links& links) {
  return std::span(links.tracks).first(links.count);
}

bool Holds(const Links& links, std::uint32_t track) {
  return std::ranges::find(All(links), track) != All(links).end();
}

bool Holds(const Links& links, std::uint32_t track, std::uint32_t own, std::uint32_t other) {
  for (std::uint32_t k = 0; k < links.count; ++k) {
    if (links.tracks[k] == track && links.own_positions[k] == own && links.other_positions[k] == other) return true;
  }
  return false;
}

// Returns true if other tracks start from it or end at it.
bool IsInUse(const Tracks& t, std::uint32_t track) {
  return std::ranges::any_of(t.states,
                             [&](const State& s) { return Holds(s.starts_from, track) || Holds(s.ends_at, track); });
}

// Returns true if links lead from one track to another one, directly or over other tracks.
bool LeadsTo(Tracks& t, std::uint32_t from, std::uint32_t to) {
  std::ranges::fill(t.reached, std::uint8_t{0});
  t.reached[from] = 1;
  bool changed = true;
  while (changed && t.reached[to] == 0) {
    changed = false;
    for (std::size_t i = 0; i < t.states.size(); ++i) {
      if (t.reached[i] == 0) continue;
      for (const Links* links : {&t.states[i].starts_from, &t.states[i].ends_at}) {
        for (const std::uint32_t other : All(*links)) {
          changed |= t.reached[other] == 0;
          t.reached[other] = 1;
        }
      }
    }
  }
  return t.reached[to] != 0;
}

// Returns true if more tracks would start or end there than a network can link at one point.
bool IsCrowded(const Tracks& t, std::uint32_t a, std::uint32_t b) {
  const auto too_many = [&](const std::vector<std::uint32_t>& at) { return a != b && at[a] + at[b] > planar::kLinks; };
  return too_many(t.starts_at) || too_many(t.ends_at);
}

// Result of the check of an order, before anything is built.
struct Look {
  Problem problem = Problem::kNone;
  bool makes = false;          // the track has to be built anew
  planar::TrackPoint point{};  // start or end of the track by the link
};

// Returns true if the track need not have a length after this order.
bool MayBeEmpty(OrderKind kind) {
  return kind != OrderKind::kCloseLoop && kind != OrderKind::kEndAt;
}

// Returns the indices of the positions of both tracks' parts at which the link holds; 0: wherever the ends meet.
std::pair<std::uint32_t, std::uint32_t> PositionsOf(const Order& order) {
  return order.only_there ? std::pair(order.own_position, order.other_position) : std::pair(0u, 0u);
}

Look LookAtLink(const Tracks& t, const Order& order) {
  const State& s = t.states[order.track];
  const Sketch& sketch = t.sketches[order.track];
  const bool starts = order.kind == OrderKind::kStartFrom;
  const planar::Track* other = t.ways[order.other];
  const planar::Track* own = t.ways[order.track];
  const Links& links = starts ? s.starts_from : s.ends_at;
  if (!other) return {Problem::kOtherEmpty};
  if (other->closed) return {Problem::kOtherClosed};
  if (sketch.closed) return {Problem::kLinked};
  const auto [own_position, other_position] = PositionsOf(order);
  if (links.count == kLinks && !Holds(links, order.other, own_position, other_position)) return {Problem::kTooMany};
  if (IsCrowded(t, starts ? t.start_nodes[order.track] : t.end_nodes[order.track],
                starts ? t.end_nodes[order.other] : t.start_nodes[order.other])) {
    return {Problem::kTooMany};
  }
  Look look{.makes = true, .point = planar::At(*other, starts ? other->length : 0)};
  look.problem = Meet(t.parts, {t.part_of[order.other], order.other_position},
                      {t.part_of[order.track], order.own_position}, look.point);
  if (look.problem != Problem::kNone) return look;
  if (starts && (own || sketch.from || sketch.count > 0)) {
    // It has a start already: the link must lead to that.
    const bool same = own ? Same(planar::At(*own, 0), look.point) : sketch.from && Same(*sketch.from, look.point);
    return {same ? Problem::kNone : Problem::kNotItsStart};
  }
  if (!starts && sketch.to) {
    return {Same(*sketch.to, look.point) ? Problem::kNone : Problem::kNotItsEnd};
  }
  return look;
}

Look LookAt(Tracks& t, const Order& order) {
  const Sketch& sketch = t.sketches[order.track];
  const bool links = order.kind == OrderKind::kStartFrom || order.kind == OrderKind::kEndAt;
  Look look{.makes = true};
  if (links) {
    look = LookAtLink(t, order);
    const bool only_links = look.problem == Problem::kNone && !look.makes;
    if (only_links && LeadsTo(t, order.other, order.track)) return {Problem::kInUse};
    if (look.problem != Problem::kNone || !look.makes) return look;
  }
  if (IsInUse(t, order.track)) return {Problem::kInUse};
  if (links) return look;
  if (order.kind == OrderKind::kClear) return {};
  if (sketch.closed) return {Problem::kClosed};
  if (order.kind == OrderKind::kCloseLoop) return look;
  if (sketch.to) return {Problem::kEnded};
  if (sketch.count == kElements) return {Problem::kTooMany};
  return look;
}

// Returns the sketch after this order; `point`: the point that a link leads to, in the coordinates of the track's part.
Sketch With(const Order& order, const planar::TrackPoint& point, Sketch sketch) {
  switch (order.kind) {
    case OrderKind::kAppend:
      sketch.elements[sketch.count++] = order.element;
      break;
    case OrderKind::kCloseLoop:
      sketch.closed = true;
      break;
    case OrderKind::kClear:
      sketch = {};
      break;
    case OrderKind::kStartFrom:
      sketch.from = point;
      break;
    case OrderKind::kEndAt:
      sketch.to = point;
      break;
  }
  return sketch;
}

void Use(Tracks& t, std::uint32_t track, const Delivery& made) {
  const planar::Track* way = made.way;
  const Delivery old{0, std::exchange(t.ways[track], way), std::exchange(t.areas[track], made.area)};
  if (old.way) t.desk.retired.TryPush(old);
  State& s = t.states[track];
  s.has_length = way != nullptr;
  s.length = way ? way->length : 0;
  NumberNetworks(t);
  ++t.changes;
}

void AddLink(Tracks& t, const Order& order) {
  State& s = t.states[order.track];
  if (order.kind != OrderKind::kStartFrom && order.kind != OrderKind::kEndAt) return;
  Links& links = order.kind == OrderKind::kStartFrom ? s.starts_from : s.ends_at;
  const auto [own, other] = PositionsOf(order);
  if (!Holds(links, order.other, own, other) && links.count < kLinks) {
    links.tracks[links.count] = order.other;
    links.own_positions[links.count] = own;
    links.other_positions[links.count++] = other;
  }
  MakeNodes(t);
}

void TakeAway(Tracks& t, std::uint32_t track) {
  State& s = t.states[track];
  t.SetSketch(track, {});
  s.starts_from = s.ends_at = {};
  Use(t, track, {});
  MakeNodes(t);
}

void End(const Context& c, Problem problem, std::uint32_t element) {
  PendingEdits& w = c.tracks.works;
  const bool good = problem == Problem::kNone;
  c.feedback.Report({w.orders[w.first].ticket, c.cycle.count, good ? FeedbackState::kDone : FeedbackState::kError,
                     false, good ? ErrorId::kNone : ErrorId::kTrackGeometry, good ? 0 : ToValue(problem, element)});
  w.orders[w.first] = {};
  w.first = (w.first + 1) % kOrders;
  --w.count;
}

// Returns the delivery for this request, and retires the others before it; one without a track if it is not there.
Delivery Fetch(BuildQueues& desk, std::uint64_t number) {
  Delivery delivery;
  while (desk.deliveries.TryPop(delivery)) {
    if (delivery.number == number) return delivery;
    desk.retired.TryPush(delivery);
  }
  return {};
}

// Whether sending succeeds is not part of the state: a replay may have no builder.
void Send(Tracks& t) {
  if (t.sent) return;
  const Order& order = t.works.orders[t.works.first];
  const Sketch& sketch = t.sketches[order.track];
  t.sent = t.desk.questions.TryPush({t.works.question, order.track, t.part_of[order.track],
                                     LargestOn(t.params[order.track]), With(order, t.works.point, sketch)});
}

// Returns the start or the end of a track, in the coordinates of its part; without a length, its linked start.
planar::TrackPoint EndOf(const Tracks& t, std::uint32_t track, bool start) {
  if (const planar::Track* way = t.ways[track]) return planar::At(*way, start ? 0 : way->length);
  return t.sketches[track].from.value_or(planar::TrackPoint{});
}

// Returns true if a link holds at the commanded positions of both parts.
bool IsInForce(const Tracks& t, std::uint32_t track, const Links& links, std::uint32_t k, bool starts) {
  const auto there = [&](std::uint32_t of, std::uint32_t position) {
    const std::uint32_t part = t.part_of[of];
    return position == 0 || part == planar::kNoPart || t.parts.now[part].commanded + 1 == position;
  };
  const std::uint32_t other = links.tracks[k];
  return there(track, links.own_positions[k]) && there(other, links.other_positions[k]) &&
         DoMeet(t.parts, t.part_of[track], EndOf(t, track, starts), t.part_of[other], EndOf(t, other, !starts));
}

}  // namespace

bool Put(const Order& order, PendingEdits& w) noexcept {
  if (w.count == kOrders) return false;
  w.orders[(w.first + w.count++) % kOrders] = order;
  return true;
}

bool HasPendingEdit(const PendingEdits& w, std::uint32_t track) noexcept {
  for (std::uint32_t i = 0; i < w.count; ++i) {
    if (w.orders[(w.first + i) % kOrders].track == track) return true;
  }
  return false;
}

void StepPendingEdits(const Context& c) noexcept {
  Tracks& t = c.tracks;
  PendingEdits& w = t.works;
  while (w.count > 0 && !w.asked) {
    const Order& order = w.orders[w.first];
    const Look look = LookAt(t, order);
    c.feedback.Report({order.ticket, c.cycle.count, FeedbackState::kActive, false, ErrorId::kNone, 0});
    if (look.problem == Problem::kNone && look.makes) {
      ++w.question;
      w.asked = true;
      w.point = look.point;
      t.sent = false;
      break;
    }
    if (look.problem == Problem::kNone) order.kind == OrderKind::kClear ? TakeAway(t, order.track) : AddLink(t, order);
    End(c, look.problem, 0);
  }
  if (w.asked) Send(t);
}

bool TakeAnswer(const Context& c, std::uint32_t track, const TrackMade& made) noexcept {
  Tracks& t = c.tracks;
  PendingEdits& w = t.works;
  const Order order = w.orders[w.first];
  if (!w.asked || made.number != w.question || track != order.track) return false;
  const bool empty = made.problem == Problem::kEmpty && MayBeEmpty(order.kind);
  if (made.problem == Problem::kNone || empty) {
    const Delivery way = empty ? Delivery{} : Fetch(t.desk, made.number);
    if (!way.way && !empty) return false;
    t.SetSketch(track, With(order, w.point, t.sketches[track]));
    Use(t, track, way);
    AddLink(t, order);
  }
  w.asked = false;
  End(c, empty ? Problem::kNone : made.problem, made.element);
  return true;
}

void NumberNetworks(Tracks& t) noexcept {
  const auto count = static_cast<std::uint32_t>(t.areas.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!t.areas[i]) continue;
    t.areas[i]->network = i;
    t.areas[i]->checks_static_objects = t.params[i].check_collision_against_static_objects;
  }
  const auto meet = [&](std::uint32_t a, std::uint32_t b) {
    return t.end_nodes[a] == t.start_nodes[b] || t.start_nodes[a] == t.end_nodes[b] ||
           t.start_nodes[a] == t.start_nodes[b] || t.end_nodes[a] == t.end_nodes[b];
  };
  bool changed = true;
  while (changed) {
    changed = false;
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t k = 0; k < i; ++k) {
        if (!t.areas[i] || !t.areas[k] || !meet(i, k) || t.areas[i]->network == t.areas[k]->network) continue;
        t.areas[i]->network = t.areas[k]->network = std::min(t.areas[i]->network, t.areas[k]->network);
        changed = true;
      }
    }
  }
}

void MakeNodes(Tracks& t) noexcept {
  const auto count = static_cast<std::uint32_t>(t.states.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    t.start_nodes[i] = 2 * i;
    t.end_nodes[i] = 2 * i + 1;
  }
  const auto join = [](std::uint32_t& a, std::uint32_t& b) {
    const bool differ = a != b;
    a = b = std::min(a, b);
    return differ;
  };
  bool changed = true;
  while (changed) {
    changed = false;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Links& from = t.states[i].starts_from;
      const Links& to = t.states[i].ends_at;
      for (std::uint32_t k = 0; k < from.count; ++k) {
        if (IsInForce(t, i, from, k, true)) changed |= join(t.start_nodes[i], t.end_nodes[from.tracks[k]]);
      }
      for (std::uint32_t k = 0; k < to.count; ++k) {
        if (IsInForce(t, i, to, k, false)) changed |= join(t.end_nodes[i], t.start_nodes[to.tracks[k]]);
      }
    }
  }
  std::ranges::fill(t.starts_at, 0u);
  std::ranges::fill(t.ends_at, 0u);
  for (std::uint32_t i = 0; i < count; ++i) {
    ++t.starts_at[t.start_nodes[i]];
    ++t.ends_at[t.end_nodes[i]];
  }
  NumberNetworks(t);
  ++t.changes;
}

}  // namespace takt::track
