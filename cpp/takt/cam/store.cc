#include "takt/cam/store.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "takt/cam/build.h"
#include "takt/core/describe.h"

namespace takt::cam {

namespace {

void Report(const Context& c, Ticket ticket, FeedbackState state, double value = 0) {
  c.feedback.Report({ticket, c.cycle, state, false, ErrorId::kNone, value});
}

void Refuse(const Context& c, Ticket ticket, double code) {
  c.feedback.Report({ticket, c.cycle, FeedbackState::kError, false, ErrorId::kCamMaking, code});
}

void Refuse(const Context& c, Ticket ticket, MakingProblem problem) {
  Refuse(c, ticket, CodeOf(problem));
}

void Finish(const Context& c, Ticket ticket) {
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
}

// Returns the draft of this name that can still be changed.
std::optional<std::size_t> FindDraft(const Store& store, const Name& name) {
  for (std::size_t i = 0; i < kDrafts; ++i) {
    const Draft& draft = store.state.drafts[i];
    if (draft.number != 0 && !draft.building && draft.name == name) return i;
  }
  return std::nullopt;
}

void Clear(Store& store, std::size_t i) {
  store.state.drafts[i] = {};
  store.drafts[i].points.clear();
  store.drafts[i].segments.clear();
}

// Returns the draft of this name, else a free one, else the oldest that is not being built.
std::optional<std::size_t> Choose(const Store& store, const Name& name) {
  if (const auto same = FindDraft(store, name)) return same;
  std::optional<std::size_t> oldest;
  for (std::size_t i = 0; i < kDrafts; ++i) {
    const Draft& draft = store.state.drafts[i];
    if (draft.building) continue;
    if (!oldest || draft.number < store.state.drafts[*oldest].number) oldest = i;
  }
  return oldest;
}

template <typename T>
struct Kind;
template <>
struct Kind<CamPoint> {
  static constexpr std::size_t kMost = kMaxPoints;
  static constexpr MakingProblem kTooMany = MakingProblem::kTooManyPoints;
};
template <>
struct Kind<CamSegment> {
  static constexpr std::size_t kMost = kMaxSegments;
  static constexpr MakingProblem kTooMany = MakingProblem::kTooManySegments;
};

// Returns the code of the problem; 0 if there is none.
template <typename T, typename Other>
double MayAdd(std::span<const T> more, std::optional<std::uint32_t> first, const std::vector<T>& list,
              const std::vector<Other>& others) {
  if (!others.empty()) return CodeOf(MakingProblem::kMixed);
  if (first && *first != list.size()) return CodeOf(MakingProblem::kOutOfOrder, list.size(), *first);
  const std::size_t count = list.size() + more.size();
  return CodeOf(count > Kind<T>::kMost ? Kind<T>::kTooMany : MakingProblem::kNone, 0,
                count > Kind<T>::kMost ? count : 0);
}

template <typename T, typename Other>
void Add(const Context& c, Ticket ticket, const Name& cam, std::span<const T> more, std::optional<std::uint32_t> first,
         std::vector<T> CamParams::*list, std::vector<Other> CamParams::*others) {
  const std::optional<std::size_t> i = FindDraft(c.store, cam);
  if (!i) return Refuse(c, ticket, MakingProblem::kNoDraft);
  CamParams& params = c.store.drafts[*i];
  Draft& draft = c.store.state.drafts[*i];
  const double wrong = MayAdd(more, first, params.*list, params.*others);
  if (wrong != 0) {
    draft.broken = true;
    return Refuse(c, ticket, wrong);
  }
  (params.*list).insert((params.*list).end(), more.begin(), more.end());  // within the capacity
  draft.count = static_cast<std::uint32_t>((params.*list).size());
  Finish(c, ticket);
}

bool IsFree(const Context& c, std::size_t index) {
  const Table& table = c.store.tables[index];
  return table.size() == 0 || (table.superseded() && !c.in_use(c.owner, static_cast<std::uint32_t>(index)));
}

std::optional<std::size_t> FreeIndex(const Context& c) {
  for (std::size_t i = c.store.of_machine; i < c.store.tables.size(); ++i) {
    if (IsFree(c, i)) return i;
  }
  return std::nullopt;
}

// Returns true if there is a free index for each cam that is being built, and one more.
bool HasRoom(const Context& c) {
  std::size_t free = 0;
  for (std::size_t i = c.store.of_machine; i < c.store.tables.size(); ++i) free += IsFree(c, i) ? 1 : 0;
  const auto building = std::ranges::count_if(c.store.state.drafts, &Draft::building);
  return free > static_cast<std::size_t>(building);
}

// Returns the index of the cam made at run time that this name refers to.
std::optional<std::size_t> FindMade(const Store& store, std::string_view name) {
  const std::optional<std::uint32_t> index = Find(store.tables, name);
  return index && *index >= store.of_machine ? std::optional<std::size_t>(*index) : std::nullopt;
}

// Returns the table built for this draft; tables of other drafts are retired.
Table* Fetch(BuildQueues& queues, std::uint64_t number) {
  for (BuiltTable built; queues.built.TryPop(built);) {
    if (built.number == number) return built.table;
    queues.retired.TryPush(built.table);
  }
  return nullptr;
}

// Adds the table under a free index, whose earlier table is retired.
void TakeOn(const Context& c, std::uint64_t number, Table* table) {
  Store& store = c.store;
  const std::size_t index = FreeIndex(c).value_or(store.tables.size() - 1);  // HasRoom has reserved one
  if (const auto earlier = FindMade(store, table->name())) store.tables[*earlier].Supersede();
  table->SetNumber(store.of_machine + number);
  std::swap(store.tables[index], *table);
  store.state.made[index - store.of_machine] = number;
  store.queues.retired.TryPush(table);
}

}  // namespace

Store::Store(const std::vector<CamParams>& cams) : of_machine(cams.size()) {
  tables.reserve(cams.size() + kMadeCams);
  for (const CamParams& cam : cams) {
    tables.push_back(Build(cam).table.value());
    tables.back().SetNumber(tables.size());
  }
  tables.resize(cams.size() + kMadeCams);
  for (CamParams& draft : drafts) {
    draft.name.reserve(Name::kCapacity);
    draft.x_unit.reserve(Name::kCapacity);
    draft.y_unit.reserve(Name::kCapacity);
    draft.points.reserve(kMaxPoints);
    draft.segments.reserve(kMaxSegments);
  }
}

void Apply(const Context& c, Ticket ticket, const BeginCam& command) noexcept {
  const std::optional<std::size_t> i = Choose(c.store, command.name);
  if (!i) return Refuse(c, ticket, MakingProblem::kBusy);
  Clear(c.store, *i);
  Draft& draft = c.store.state.drafts[*i];
  draft.number = ++c.store.state.drafts_begun;
  draft.name = command.name;
  CamParams& params = c.store.drafts[*i];
  params.name.assign(command.name.view());
  params.x_unit.assign(command.x_unit.view());
  params.y_unit.assign(command.y_unit.view());
  params.cyclic = command.cyclic;
  params.interpolation = command.interpolation;
  Finish(c, ticket);
}

void Apply(const Context& c, Ticket ticket, const AddCamPoints& command) noexcept {
  Add(c, ticket, command.cam, command.points.all(), command.first, &CamParams::points, &CamParams::segments);
}

void Apply(const Context& c, Ticket ticket, const AddCamSegments& command) noexcept {
  Add(c, ticket, command.cam, command.segments.all(), command.first, &CamParams::segments, &CamParams::points);
}

void Apply(const Context& c, Ticket ticket, const BuildCam& command) noexcept {
  const std::optional<std::size_t> i = FindDraft(c.store, command.cam);
  if (!i) return Refuse(c, ticket, MakingProblem::kNoDraft);
  Draft& draft = c.store.state.drafts[*i];
  const std::uint32_t has = draft.count, given = command.count.value_or(has);
  if (draft.broken || given != has) {
    const bool broken = draft.broken;
    Clear(c.store, *i);
    return broken ? Refuse(c, ticket, MakingProblem::kIncomplete)
                  : Refuse(c, ticket, CodeOf(MakingProblem::kMissing, has, given));
  }
  if (!HasRoom(c)) return Refuse(c, ticket, MakingProblem::kNoRoom);
  draft.ticket = ticket;
  draft.building = true;
  c.store.queues.requests.TryPush({draft.number, ticket, &c.store.drafts[*i]});  // as many fit as there are drafts
  Report(c, ticket, FeedbackState::kActive);
}

void Apply(const Context& c, Ticket ticket, const DropCam& command) noexcept {
  const std::optional<std::size_t> index = FindMade(c.store, command.cam.view());
  if (!index) return Refuse(c, ticket, MakingProblem::kNotMade);
  c.store.tables[*index].Supersede();
  Finish(c, ticket);
}

void Apply(const Context& c, Ticket ticket, const ReadCam& command) noexcept {
  const std::vector<Table>& tables = c.store.tables;
  const auto found = std::ranges::find_if(tables, [&](const Table& table) {
    return table.size() > 0 && (command.number ? table.number() == *command.number
                                               : !table.superseded() && table.name() == command.cam.view());
  });
  if (found == tables.end()) return Refuse(c, ticket, MakingProblem::kUnknown);
  // A name may refer to a cam of the machine file and to one that hides it.
  const Table& table = command.number ? *found : tables[*Find(tables, command.cam.view())];
  const CamParams& source = table.source();
  const std::size_t total = source.points.size() + source.segments.size();  // one of them is empty
  if (command.first >= total) return Refuse(c, ticket, CodeOf(MakingProblem::kBehindEnd, total, command.first));
  CamPiece piece;
  piece.cycle = c.cycle;
  piece.number = table.number();
  piece.name = Name::Of(source.name);
  piece.x_unit = Name::Of(source.x_unit);
  piece.y_unit = Name::Of(source.y_unit);
  piece.cyclic = source.cyclic;
  piece.interpolation = source.interpolation;
  piece.total = static_cast<std::uint32_t>(total);
  piece.first = command.first;
  for (std::size_t i = command.first; i < source.points.size() && piece.points.Add(source.points[i]);) ++i;
  for (std::size_t i = command.first; i < source.segments.size() && piece.segments.Add(source.segments[i]);) ++i;
  c.store.pieces.TryPush(piece);
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone, static_cast<double>(total));
}

void Apply(const Context& c, Ticket, const CamBuilt& result) noexcept {
  for (std::size_t i = 0; i < kDrafts; ++i) {
    const Draft draft = c.store.state.drafts[i];
    if (!draft.building || draft.number != result.number) continue;
    Table* table = result.good ? Fetch(c.store.queues, result.number) : nullptr;
    if (table) TakeOn(c, result.number, table);
    Clear(c.store, i);
    if (!table) return Refuse(c, draft.ticket, MakingProblem::kFaulty);
    return Report(c, draft.ticket, FeedbackState::kDone, static_cast<double>(c.store.of_machine + result.number));
  }
}

void describe(Description<Draft>& d) {
  d.named("CamDraft");
  d.about("A cam that is being sent or built.");
  d.internal<&Draft::number>("Number of the draft, from 1.");
  d.internal<&Draft::name>("Name of the cam.");
  d.internal<&Draft::ticket>("Ticket of the command that builds it.");
  d.internal<&Draft::count>("Number of points or segments.");
  d.internal<&Draft::broken>("A piece was refused.");
  d.internal<&Draft::building>("It is being built.");
}

void describe(Description<StoreState>& d) {
  using S = StoreState;
  d.named("CamStoreState");
  d.about("Cams made at run time.");
  d.internal<&S::drafts>("Drafts that are being sent or built.");
  d.internal<&S::made>("Number of the draft of each cam.");
  d.internal<&S::drafts_begun>("Drafts begun so far.");
}

}  // namespace takt::cam
