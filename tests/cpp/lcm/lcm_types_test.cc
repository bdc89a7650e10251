// Compares lcmtypes/*.lcm with the descriptions of their contents.

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "takt/axis/outputs.h"
#include "takt/conveyor/state.h"
#include "takt/core/describe.h"
#include "takt/core/feedback.h"
#include "takt/core/ports.h"
#include "takt/engine/components.h"
#include "takt/engine/scheduler.h"
#include "takt/engine/snapshot.h"
#include "takt/flexcam/outputs.h"
#include "takt/group/outputs.h"
#include "takt/msgs/engine_state.hpp"
#include "takt/msgs/feedback.hpp"

namespace takt::lcm {
namespace {

struct LcmField {
  std::string type;
  std::string unit;  // as in "// [u/s] ..."; empty: none
};

struct LcmType {
  std::map<std::string, LcmField> fields;
  std::map<std::string, int> constants;
};

std::vector<std::string> Words(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

LcmType Parse(const std::filesystem::path& path) {
  LcmType type;
  std::string unit;
  bool in_struct = false, in_constants = false;
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> words = Words(line);
    if (words.empty()) continue;
    if (words[0] == "struct") in_struct = true;
    if (words[0] == "const") in_constants = true;
    if (words[0] == "//") {
      if (words.size() > 1 && words[1].starts_with('[')) unit = words[1].substr(1, words[1].find(']') - 1);
    } else if (in_constants) {  // const int8_t STATE_DISABLED = 0, STATE_STANDSTILL = 1,
      for (std::size_t i = 0; i + 2 < words.size(); ++i) {
        if (words[i + 1] == "=") type.constants[words[i]] = std::stoi(words[i + 2]);
      }
    } else if (in_struct && words.size() == 2 && words[1].ends_with(';')) {  // double set_position;
      type.fields[words[1].substr(0, words[1].find_first_of("[;"))] = {words[0], unit};
      unit.clear();
    }
  }
  return type;
}

std::filesystem::path Folder() {
  return std::filesystem::path(TAKT_SOURCE_DIR) / "lcmtypes";
}

bool Carries(const std::string& lcm_type, const Type& type) {
  static const std::set<std::string> integers{"int8_t", "int16_t", "int32_t", "int64_t"};
  switch (type.kind) {
    case Kind::kBool:
      return lcm_type == "boolean";
    case Kind::kReal:
      return lcm_type == "double";
    case Kind::kInteger:
    case Kind::kEnum:
      return integers.contains(lcm_type);
    case Kind::kArray:
      return Carries(lcm_type, *type.element);
    case Kind::kStruct: {
      std::string name;  // AxisNumbers: axis_numbers
      for (const char c : type.name) {
        if (std::isupper(c) != 0 && !name.empty()) name += '_';
        name += static_cast<char>(std::tolower(c));
      }
      return lcm_type == name;
    }
    default:
      return false;
  }
}

void ExpectSameFields(const std::string& file, const Type& described, const std::set<std::string>& of_the_message) {
  const LcmType type = Parse(Folder() / file);
  for (const Field& field : described.fields) {
    const auto found = type.fields.find(std::string(field.name));
    ASSERT_NE(found, type.fields.end()) << file << " lacks " << field.name;
    EXPECT_EQ(found->second.unit, field.unit.text) << file << ": unit of " << field.name;
    EXPECT_TRUE(Carries(found->second.type, *field.type)) << file << ": " << field.name << " as " << found->second.type;
  }
  for (const auto& [name, field] : type.fields) {
    EXPECT_TRUE(described.FindField(name) != nullptr || of_the_message.contains(name))
        << file << ": " << name << " is not described";
  }
}

// ERROR_STOP and ErrorStop are the same name.
std::string Letters(const std::string& name) {
  std::string letters;
  for (const char c : name) {
    if (c != '_') letters += static_cast<char>(std::tolower(c));
  }
  return letters;
}

void ExpectSameConstants(const std::string& file, const std::string& prefix, const Type& enumeration) {
  const LcmType type = Parse(Folder() / file);
  std::size_t found = 0;
  for (const auto& [name, value] : type.constants) {
    if (!name.starts_with(prefix)) continue;
    ++found;
    const Enumerator* enumerator = enumeration.FindEnumerator(std::int64_t{value});
    ASSERT_NE(enumerator, nullptr) << name;
    EXPECT_EQ(Letters(name.substr(prefix.size())), Letters(std::string(enumerator->name)));
  }
  EXPECT_EQ(found, enumeration.enumerators.size()) << prefix;
}

// EN-11
TEST(LcmTypes, StatesSayWhatTheDescriptionsOfOutputsSay) {
  const std::set<std::string> own = {"utime", "cycle", "time_ns", "sequence", "name", "drive_error_text"};
  for (const engine::ComponentKind& kind : engine::ComponentKinds()) {
    ExpectSameFields(std::string(kind.name) + "_state.lcm", *kind.outputs, own);
  }
}

// EN-11
TEST(LcmTypes, FlexCamStateSaysWhatTheDescriptionOfOutputsSays) {
  ExpectSameFields("flex_cam_state.lcm", TypeOf<flexcam::Outputs>(), {"utime", "cycle", "time_ns", "sequence", "name"});
}

// EN-11
TEST(LcmTypes, EngineStateSaysWhatTheDescriptionOfFiguresSays) {
  ExpectSameFields(
      "engine_state.lcm", TypeOf<engine::EngineFigures>(),
      {"utime", "time_ns", "sequence", "run_id", "pace", "period_s", "malformed", "ignored", "other_run", "has_key",
       "untagged", "wrong_key", "replayed", "stale", "send_failures", "replies_dropped", "clients"});
  ExpectSameFields("histogram.lcm", TypeOf<engine::Histogram>(), {});
}

// GR-10
TEST(LcmTypes, PoseSaysWhatTheDescriptionOfPosesSays) {
  ExpectSameFields("pose.lcm", TypeOf<kinematics::Pose>(), {});
}

// EN-26, AX-87
TEST(LcmTypes, DriveMessagesSayWhatTheDescriptionsOfThePortsSay) {
  ExpectSameFields("drive_setpoint.lcm", TypeOf<ServoOutputs>(),
                   {"utime", "run_id", "cycle", "sequence", "axis", "period_s", "real_time"});
  ExpectSameFields("drive_feedback.lcm", TypeOf<ServoInputs>(),
                   {"utime", "run_id", "cycle", "sequence", "axis", "plant", "later_s"});
  ExpectSameConstants("drive_setpoint.lcm", "MODE_", TypeOf<DriveMode>());
}

// EN-11
TEST(LcmTypes, ConstantsAreTheEnumsMembers) {
  const Type& outputs = TypeOf<axis::Outputs>();
  ExpectSameConstants("flex_cam_state.lcm", "STATE_", TypeOf<flexcam::ModuleState>());
  ExpectSameConstants("axis_state.lcm", "STATE_", *outputs.FindField("state")->type);
  ExpectSameConstants("flex_cam_state.lcm", "STATE_", TypeOf<flexcam::ModuleState>());
  ExpectSameConstants("axis_state.lcm", "LIMITED_BY_", *outputs.FindField("limited_by")->type);
  ExpectSameConstants("group_state.lcm", "STATE_", TypeOf<group::GroupState>());
  ExpectSameConstants("group_state.lcm", "TRACK_", TypeOf<group::TrackState>());
  ExpectSameConstants("belt_object.lcm", "STATE_", TypeOf<conveyor::ObjectState>());
  ExpectSameConstants("mover_state.lcm", "STATE_", TypeOf<planar::ObjectState>());
  ExpectSameConstants("mover_state.lcm", "MODE_", TypeOf<mover::CommandMode>());
  ExpectSameConstants("mover_state.lcm", "LIMITED_BY_", TypeOf<LimitedBy>());
  ExpectSameConstants("mover_state.lcm", "EXTERNAL_", TypeOf<mover::SetpointMode>());
  ExpectSameConstants("track_state.lcm", "STATE_", TypeOf<planar::ObjectState>());
  ExpectSameConstants("track_state.lcm", "MODE_", TypeOf<track::OperationMode>());
  ExpectSameConstants("planar_group_state.lcm", "STATE_", TypeOf<planar::ObjectState>());
  ExpectSameConstants("feedback.lcm", "OBJECT_", TypeOf<ObjectKind>());
  ExpectSameConstants("part_state.lcm", "STATE_", TypeOf<planar::ObjectState>());
  ExpectSameConstants("group_state.lcm", "REASON_", TypeOf<kinematics::Reason>());
  ExpectSameConstants("group_state.lcm", "PROBLEM_", TypeOf<path::Problem>());

  using F = msgs::feedback;
  EXPECT_EQ(F::STATE_BUSY, static_cast<int>(FeedbackState::kBusy));
  EXPECT_EQ(F::STATE_ACTIVE, static_cast<int>(FeedbackState::kActive));
  EXPECT_EQ(F::STATE_DONE, static_cast<int>(FeedbackState::kDone));
  EXPECT_EQ(F::STATE_ABORTED, static_cast<int>(FeedbackState::kAborted));
  EXPECT_EQ(F::STATE_ERROR, static_cast<int>(FeedbackState::kError));

  using E = msgs::engine_state;
  EXPECT_EQ(E::PACE_REAL_TIME, static_cast<int>(engine::Pace::kRealTime));
  EXPECT_EQ(E::PACE_PACED, static_cast<int>(engine::Pace::kPaced));
  EXPECT_EQ(E::PACE_FAST, static_cast<int>(engine::Pace::kFast));
}

// EN-20: except quantities in the units of a cam, or of a master that is known to the machine file only.
TEST(LcmTypes, EveryRealNumberAndEveryTimeHasAUnit) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(Folder())) {
    if (entry.path().extension() != ".lcm") continue;
    ++files;
    for (const auto& [name, field] : Parse(entry.path()).fields) {
      const bool of_cam = entry.path().filename() == "flex_cam_state.lcm";
      const bool needs_unit = (field.type == "double" && !of_cam) || name == "utime" || name.ends_with("_ns");
      EXPECT_TRUE(!needs_unit || !field.unit.empty()) << entry.path() << ": " << name;
    }
  }
  EXPECT_EQ(files, 31);
}

}  // namespace
}  // namespace takt::lcm
