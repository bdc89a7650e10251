#include "takt/lcm/drive_gate.h"

#include <algorithm>
#include <cmath>

#include "takt/core/problem.h"
#include "takt/lcm/channels.h"

namespace takt::lcm {

namespace {

constexpr std::size_t kMostSaid = 1000;  // maximum number of sentences

std::string Number(std::int64_t number) {
  return std::to_string(number);
}

std::string NotFinite(const msgs::drive_feedback& m) {
  const auto wrong = [](const char* name, double value, const char* expected) {
    return std::string(name) + ": expected " + expected + ", found " + std::to_string(value);
  };
  if (!std::isfinite(m.torque_nm)) return wrong("torque_nm", m.torque_nm, "a finite number");
  if (!std::isfinite(m.later_s)) return wrong("later_s", m.later_s, "a finite number");
  for (const auto& [name, age] :
       {std::pair("probe_rise_age_s", m.probe_rise_age_s), {"probe_fall_age_s", m.probe_fall_age_s}}) {
    if (!std::isfinite(age) || age < 0) return wrong(name, age, "a finite number >= 0");
  }
  return "";
}

}  // namespace

DriveGate::DriveGate(const engine::Machine& machine, std::int64_t run_id, Refuse refuse)
    : machine_(machine), run_id_(run_id), refuse_(std::move(refuse)), sent_(machine.external.drives.size()) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const engine::ExternalDrive* drive = engine::ExternalOf(machine, i);
    if (drive == nullptr) continue;
    drives_.push_back({.axis = static_cast<std::uint32_t>(i),
                       .missing_cycles = drive->missing_cycles,
                       .channel = DriveFeedbackChannel(drive->axis)});
  }
}

std::size_t DriveGate::DriveOf(std::uint32_t axis) const {
  const auto drive = std::find_if(drives_.begin(), drives_.end(), [&](const Drive& d) { return d.axis == axis; });
  return static_cast<std::size_t>(drive - drives_.begin());
}

void DriveGate::OnSent(const engine::DriveSetPoint& set_point) {
  Sent& sent = sent_[DriveOf(set_point.axis)];
  if (sent.cycle.exchange(set_point.cycle) == set_point.cycle) sent.AgainAt(set_point.cycle) = set_point.cycle;
}

std::optional<engine::DriveSample> DriveGate::Take(std::string_view channel, std::span<const std::uint8_t> bytes) {
  const auto drive = std::find_if(drives_.begin(), drives_.end(), [&](const Drive& d) { return d.channel == channel; });
  if (drive == drives_.end()) {
    Say(channel, {Reason::kChannel, UnknownChannel(channel)});
    return {};
  }
  const std::optional<msgs::drive_feedback> message = DecodeDriveFeedback(bytes);
  if (!message) {
    Say(channel, {Reason::kType, "no drive_feedback of this version of Takt"});
    return {};
  }
  const auto index = static_cast<std::size_t>(drive - drives_.begin());
  if (const std::optional<Refusal> refusal = Diagnose(*message, index)) {
    const bool asked_for = refusal->reason == Reason::kOld && message->cycle == sent_[index].AgainAt(message->cycle);
    if (!asked_for) Say(channel, *refusal);
    return {};
  }
  drive->answered = message->cycle;
  drive->plant = message->plant;
  return ToSample(*message, drive->axis);
}

std::optional<DriveGate::Refusal> DriveGate::Diagnose(const msgs::drive_feedback& m, std::size_t index) const {
  const Drive& drive = drives_[index];
  const std::string& axis = machine_.axes[drive.axis].name;
  const std::int64_t sent = sent_[index].cycle;
  if (m.axis != axis) return Refusal{Reason::kAxis, "axis: expected " + axis + ", found " + Quoted(m.axis)};
  if (m.run_id != run_id_) {
    return Refusal{Reason::kRun, "answers another start of an engine: run_id " + Number(m.run_id) + ", this one is " +
                                     Number(run_id_)};
  }
  if (m.cycle < -1 || m.cycle > sent) {
    return Refusal{Reason::kFuture,
                   "answers cycle " + Number(m.cycle) + ", but the newest set point is that of cycle " + Number(sent)};
  }
  if (std::string sentence = NotFinite(m); !sentence.empty()) return Refusal{Reason::kNumber, std::move(sentence)};
  if (drive.answered == kNothing) return {};
  if (m.plant != drive.plant) {
    // Another plant may take over only after the engine has run without the first one: it cannot know its state.
    if (sent - drive.answered > drive.missing_cycles) return {};
    return Refusal{Reason::kPlant, "a second plant answers for this axis; the first one is listened to"};
  }
  // The order is that of the cycles, which the engine numbers: the sender's sequence could jump so far that no later
  // message would be newer.
  if (m.cycle <= drive.answered) {
    return Refusal{Reason::kOld, "cycle " + Number(m.cycle) + " after cycle " + Number(drive.answered) +
                                     ": old, out of order or twice"};
  }
  return {};
}

std::string DriveGate::UnknownChannel(std::string_view channel) const {
  constexpr std::string_view kBegin = "takt/drive/";
  constexpr std::string_view kEnd = "/feedback";
  const std::string_view name = channel.substr(kBegin.size(), channel.size() - kBegin.size() - kEnd.size());
  std::vector<std::string_view> names;
  for (const axis::AxisParams& axis : machine_.axes) {
    if (axis.name == name) return "the machine's external.drives do not name axis " + axis.name;
    names.push_back(axis.name);
  }
  return "expected the name of an axis, found " + Quoted(name) + DidYouMean(name, names);
}

void DriveGate::Say(std::string_view channel, const Refusal& refusal) {
  const bool news = said_.size() < kMostSaid && said_.emplace(channel, refusal.reason).second;
  refuse_(news ? std::string(channel) + ": " + refusal.sentence : "");
}

}  // namespace takt::lcm
