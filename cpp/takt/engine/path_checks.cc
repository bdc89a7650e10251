#include "takt/engine/path_checks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include "takt/cam/commands.h"
#include "takt/core/scalar.h"
#include "takt/environment/environments.h"
#include "takt/group/failures.h"
#include "takt/group/survey.h"
#include "takt/mover/command_mode.h"
#include "takt/mover/route.h"
#include "takt/planar/problem.h"
#include "takt/planar/send.h"
#include "takt/track/sketch.h"
#include "takt/workspace/trouble.h"

namespace takt::engine {

namespace {

using group::PathChecked;
using group::Survey;
using workspace::Finding;
using workspace::Sample;
using workspace::Trouble;

constexpr auto kIdleWait = std::chrono::milliseconds(1);
// Samples that are checked in one run: starting a run costs more than a sample.
constexpr std::size_t kSamplesAtOnce = 1000;
// Sentences about refused moves whose end has not been reported yet.
constexpr std::size_t kSentences = 1024;

std::string_view UnitOf(path::Measure measure) {
  if (measure == path::Measure::kAuxiliaries) return "units";
  return measure == path::Measure::kTurn ? "deg" : "mm";
}

std::string InElement(std::uint32_t element) {
  return element == 0 ? "" : ", in element " + std::to_string(element);
}

std::string TrackSentence(double value) {
  const std::string_view text = planar::Text(track::ProblemOf(value));
  const std::string why(text.empty() ? ErrorText(ErrorId::kTrackGeometry) : text);
  return why + InElement(track::ElementOf(value));
}

std::string StatorSentence(double value) {
  const std::string_view text = planar::Text(environment::ProblemOf(value));
  const std::string why(text.empty() ? ErrorText(ErrorId::kStators) : text);
  const std::uint32_t stator = environment::StatorOf(value);
  return stator == 0 ? why : why + ", found with stator " + std::to_string(stator);
}

std::string CamSentence(double value) {
  const std::string sentence = cam::MessageOf(value);
  return sentence.empty() ? std::string(ErrorText(ErrorId::kCamMaking)) : sentence;
}

std::string_view NoWaySentence(double value) {
  switch (static_cast<planar::UnreachableReason>(value)) {
    case planar::UnreachableReason::kDirection:
      return "the direction does not lead to the target from where the mover can stop";
    case planar::UnreachableReason::kTooLong:
      return "the way has more than 256 tracks";
    case planar::UnreachableReason::kPartAway:
      return "the way leads over a part that is elsewhere";
    default:
      return ErrorText(ErrorId::kNoRoute);
  }
}
static_assert(planar::kRouteTracks == 256, "NoWaySentence says so");

// Rounds to three decimals; a whole number without any.
std::string Rounded(double value) {
  std::string text = FormatReal(std::round(value * 1000) / 1000);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

std::string RouteSentence(double value) {
  const std::string_view why = mover::MessageOf(static_cast<mover::RouteProblem>(value));
  return std::string(why.empty() ? ErrorText(ErrorId::kRoute) : why);
}

std::string GapSentence(double least) {
  return std::string(ErrorText(ErrorId::kGapTooSmall)) + ": expected at least " +
         FormatReal(std::ceil(least * 1000) / 1000) + " mm";
}

std::string ModeSentence(double value) {
  const auto* mode = TypeOf<mover::CommandMode>().FindEnumerator(static_cast<std::int64_t>(value));
  return std::string(ErrorText(ErrorId::kCommandMode)) + (mode ? "; it is in " + std::string(mode->name) : "");
}

// Returns "mover two"; empty if there is no object.
std::string NameOf(const ObjectInfo& object, const Machine& machine) {
  const auto name = [&](const char* kind, const auto& list) {
    return object.number == 0 || object.number > list.size() ? std::string() : kind + list[object.number - 1].name;
  };
  switch (object.kind) {
    case ObjectKind::kPart:
      return name("part ", machine.parts);
    case ObjectKind::kCoordinateSystem:
      return name("coordinate system ", machine.coordinate_systems);
    case ObjectKind::kAxis:
      return name("axis ", machine.axes);
    case ObjectKind::kMover:
      return name("mover ", machine.movers);
    case ObjectKind::kTrack:
      return name("track ", machine.tracks);
    case ObjectKind::kGroup:
      return name("group ", machine.planar_groups);
    case ObjectKind::kEnvironment:
      return name("environment ", machine.environments);
    default:
      return {};
  }
}

// The check of one request: contiguous parts of the path are checked together.
class Inquiry {
 public:
  explicit Inquiry(workspace::Checker& checker) : checker_(checker) {}

  // Returns false if a problem was found, so that the remaining path need not be checked.
  bool Take(const Survey::Part& part) {
    unit_ = UnitOf(part.measure);
    if (part.on_blend) {
      const std::optional<Finding> found = checker_.Check(part.samples);
      if (!found) return true;
      if (CheckLine()) Note(*found, part.element, true);
      return false;
    }
    for (const Sample& sample : part.samples) {
      if (!line_.empty() && &sample == part.samples.data()) continue;  // the last sample of the previous part
      line_.push_back(sample);
      elements_.push_back(part.element);
    }
    return line_.size() < kSamplesAtOnce || CheckLine();
  }

  // `lost`: why the axes have no position after the last part.
  void End(kinematics::Reason lost) {
    if (finding_ || !CheckLine() || lost == kinematics::Reason::kNone) return;
    Finding finding{.trouble = Trouble::kNoPose, .first = "tool", .second = {}, .joints = {}, .reason = lost};
    if (!line_.empty()) finding.s = line_.back().s;
    Note(finding, elements_.empty() ? 0 : elements_.back(), false);
  }

  const std::optional<Finding>& finding() const { return finding_; }
  std::uint32_t element() const { return element_; }
  bool on_blend() const { return on_blend_; }
  std::string_view unit() const { return unit_; }

 private:
  void Note(const Finding& finding, std::uint32_t element, bool on_blend) {
    finding_ = finding;
    element_ = element;
    on_blend_ = on_blend;
  }

  // Checks the collected samples. Returns false if a problem was found. The last sample is kept: the next part begins
  // there.
  bool CheckLine() {
    if (line_.size() < 2) return true;
    const std::optional<Finding> found = checker_.Check(line_);
    if (found) {
      const std::size_t next = std::min(found->index + (found->s > line_[found->index].s ? 1 : 0), line_.size() - 1);
      Note(*found, elements_[next], false);
      return false;
    }
    line_.erase(line_.begin(), line_.end() - 1);
    elements_.erase(elements_.begin(), elements_.end() - 1);
    return true;
  }

  workspace::Checker& checker_;
  std::vector<Sample> line_;
  std::vector<std::uint32_t> elements_;  // of each sample
  std::optional<Finding> finding_;
  std::uint32_t element_ = 0;
  bool on_blend_ = false;
  std::string_view unit_ = "mm";
};

}  // namespace

struct PathChecks::OfGroup {
  OfGroup(const group::Fixed& fixed, workspace::Checker its)
      : checker(std::move(its)),
        survey(fixed),
        parts(workspace::PartNames(fixed.params.workspace.value(), fixed.kinematics)) {}

  // Returns the number of the part, from 1; 0: none.
  std::uint32_t NumberOf(const std::string& part) const {
    const auto found = std::ranges::find(parts, part);
    return found == parts.end() ? 0 : static_cast<std::uint32_t>(found - parts.begin() + 1);
  }

  workspace::Checker checker;
  Survey survey;
  std::vector<std::string> parts;
  std::optional<group::PathCheckRequest> asked{};  // last request
};

PathChecks::PathChecks(Engine& engine, Checkers checkers) : engine_(engine) {
  engine_.PlanElsewhere();
  for (std::size_t i = 0; i < checkers.size(); ++i) {
    groups_.push_back(checkers[i] ? std::make_unique<OfGroup>(engine.fixed(i), std::move(*checkers[i])) : nullptr);
  }
}

PathChecks::~PathChecks() = default;

void PathChecks::Run() {
  engine_.MakePlans();
  engine_.MakeTracks();
  while (const std::optional<cam::BuildResult> result = engine_.BuildCam()) {
    if (!result->sentence.empty()) Remember(result->ticket, result->sentence);
    engine_.Answer(result->built);
  }
  group::PathCheckRequest question;
  bool any = false;
  while (engine_.questions().TryPop(question)) {  // earlier requests are not waited for any more
    const std::size_t index = question.group - 1;
    if (index >= groups_.size() || !groups_[index]) continue;
    groups_[index]->asked = question;
    any = true;
  }
  if (!any) return;
  for (const auto& group : groups_) {
    if (!group || !group->asked) continue;
    engine_.Answer(group->asked->group - 1, Check(*group->asked));
    group->asked.reset();
  }
}

PathChecked PathChecks::Check(const group::PathCheckRequest& question) {
  OfGroup& group = *groups_[question.group - 1];
  group.checker.SetToolCentre({question.tool.x, question.tool.y, question.tool.z});
  Inquiry inquiry(group.checker);
  inquiry.End(group.survey.Run(question, [&](const Survey::Part& part) { return inquiry.Take(part); }));
  PathChecked answer{.number = question.number};
  if (!inquiry.finding()) return answer;
  const Finding& finding = *inquiry.finding();
  answer.trouble = finding.trouble;
  answer.reason = finding.reason;
  answer.first = group.NumberOf(finding.first);
  answer.second = group.NumberOf(finding.second);
  answer.element = inquiry.element();
  answer.place = finding.s;
  answer.on_blend = inquiry.on_blend();
  Remember(question.move.ticket, group.checker.Describe(finding, inquiry.unit()) + InElement(answer.element) +
                                     (answer.on_blend ? ", where the corner before it is rounded" : ""));
  return answer;
}

void PathChecks::Remember(Ticket ticket, std::string sentence) {
  const std::lock_guard lock(mutex_);
  sentences_.emplace_back(ticket, std::move(sentence));
  if (sentences_.size() > kSentences) sentences_.pop_front();
}

std::string PathChecks::Sentence(const FeedbackEvent& event) {
  if (event.error == ErrorId::kNone) return {};
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(sentences_, event.ticket, &std::pair<Ticket, std::string>::first);
  if (found == sentences_.end()) return SentenceNaming(event, engine_.machine());
  std::string sentence = std::move(found->second);
  sentences_.erase(found);
  // The command may have ended for another reason meanwhile.
  const bool as_answered = event.error == ErrorId::kCollision || event.error == ErrorId::kUnreachable ||
                           event.error == ErrorId::kSingular || event.error == ErrorId::kCamMaking;
  return as_answered ? sentence : SentenceNaming(event, engine_.machine());
}

std::string Sentence(const FeedbackEvent& event) {
  if (event.error == ErrorId::kNone) return {};
  const bool of_path = event.error == ErrorId::kCollision || event.error == ErrorId::kUnreachable ||
                       event.error == ErrorId::kSingular || event.error == ErrorId::kPathGeometry;
  if (event.error == ErrorId::kTrackGeometry) return TrackSentence(event.value);
  if (event.error == ErrorId::kCamMaking) return CamSentence(event.value);
  if (event.error == ErrorId::kStators) return StatorSentence(event.value);
  if (event.error == ErrorId::kGapTooSmall) return GapSentence(event.value);
  if (event.error == ErrorId::kCommandMode) return ModeSentence(event.value);
  if (event.error == ErrorId::kNoRoute) return std::string(NoWaySentence(event.value));
  if (event.error == ErrorId::kRoute) return RouteSentence(event.value);
  const std::string text(ErrorText(event.error));
  return of_path && event.value > 0 ? text + InElement(static_cast<std::uint32_t>(event.value)) : text;
}

std::string SentenceNaming(const FeedbackEvent& event, const Machine& machine) {
  if (event.detail != 0) {
    const group::Failures failures(event.detail);
    const std::string sentence = failures.Sentence(machine.groups[failures.group() - 1].axes);
    if (!sentence.empty()) return sentence + InElement(static_cast<std::uint32_t>(event.value));
  }
  const std::string object = NameOf(event.object, machine);
  if (object.empty()) return Sentence(event);
  const bool of_track = event.object.kind == ObjectKind::kTrack;
  if (event.error == ErrorId::kTargetBehindLimit && of_track) {
    return "the target is not on " + object + ": expected 0 to " + Rounded(event.value) + " mm";
  }
  if (event.error == ErrorId::kTargetBehindLimit) {
    return "the target is outside the limits of " + object + ": the nearest position allowed is " +
           Rounded(event.value);
  }
  if (event.error == ErrorId::kParameter && of_track) {
    return "turns, their directions and modulo tolerances are for closed loops, and " + object + " is open";
  }
  if (event.error == ErrorId::kAxisFault) return "a fault of " + object + " stopped it";
  if (event.error == ErrorId::kOffStators) return Sentence(event) + "; it is on " + object;
  return Sentence(event) + ": " + object;
}

PathCheckThread::PathCheckThread(PathChecks& checks)
    : thread_([this, &checks] {
        while (!stop_) {
          checks.Run();
          std::this_thread::sleep_for(kIdleWait);
        }
      }) {}

PathCheckThread::~PathCheckThread() {
  stop_ = true;
  thread_.join();
}

}  // namespace takt::engine
