// Conversion between the engine's structs and LCM messages. Pure functions; fields that only the sender knows (utime,
// sequence, run_id) stay 0.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/cam/commands.h"
#include "takt/core/feedback.h"
#include "takt/engine/drives.h"
#include "takt/engine/machine.h"
#include "takt/engine/snapshot.h"
#include "takt/engine/track_shapes.h"
#include "takt/msgs/axis_state.hpp"
#include "takt/msgs/belt_objects.hpp"
#include "takt/msgs/belt_state.hpp"
#include "takt/msgs/cam_piece.hpp"
#include "takt/msgs/command.hpp"
#include "takt/msgs/drive_feedback.hpp"
#include "takt/msgs/drive_setpoint.hpp"
#include "takt/msgs/engine_state.hpp"
#include "takt/msgs/environment_state.hpp"
#include "takt/msgs/feedback.hpp"
#include "takt/msgs/flex_cam_state.hpp"
#include "takt/msgs/group_state.hpp"
#include "takt/msgs/heartbeat.hpp"
#include "takt/msgs/journal_command.hpp"
#include "takt/msgs/journal_drive.hpp"
#include "takt/msgs/journal_hashes.hpp"
#include "takt/msgs/journal_start.hpp"
#include "takt/msgs/machine_description.hpp"
#include "takt/msgs/mover_route.hpp"
#include "takt/msgs/mover_state.hpp"
#include "takt/msgs/mover_trail.hpp"
#include "takt/msgs/part_state.hpp"
#include "takt/msgs/pick_place_state.hpp"
#include "takt/msgs/planar_group_state.hpp"
#include "takt/msgs/pose_state.hpp"
#include "takt/msgs/track_shape.hpp"
#include "takt/msgs/track_state.hpp"

namespace takt::lcm {

msgs::axis_state ToMessage(const engine::AxisSnapshot& snapshot, const engine::Machine& machine);
msgs::flex_cam_state ToMessage(const engine::FlexCamSnapshot& snapshot, const engine::Machine& machine);
msgs::group_state ToMessage(const engine::GroupSnapshot& snapshot, const engine::Machine& machine);
msgs::belt_state ToMessage(const engine::BeltSnapshot& snapshot, const engine::Machine& machine);
msgs::belt_objects ToMessage(const engine::ObjectsSnapshot& snapshot, const engine::Machine& machine);
msgs::cam_piece ToMessage(const cam::CamPiece& piece, const engine::Machine& machine);
// Appends the points to those that `shape` already holds.
void Add(const engine::TrackPlaces& places, const engine::Machine& machine, msgs::track_shape& shape);
msgs::pick_place_state ToMessage(const engine::PickPlaceSnapshot& snapshot, const engine::Machine& machine);
msgs::mover_state ToMessage(const engine::MoverSnapshot& snapshot, const engine::Machine& machine);
msgs::mover_trail ToMessage(const engine::TrailSnapshot& snapshot, const engine::Machine& machine);
msgs::mover_route ToMessage(const engine::RouteSnapshot& snapshot, const engine::Machine& machine);
msgs::pose_state ToMessage(const engine::PoseSnapshot& snapshot, const engine::Machine& machine);
msgs::track_state ToMessage(const engine::TrackSnapshot& snapshot, const engine::Machine& machine);
msgs::planar_group_state ToMessage(const engine::PlanarGroupSnapshot& snapshot, const engine::Machine& machine);
msgs::environment_state ToMessage(const engine::EnvironmentSnapshot& snapshot, const engine::Machine& machine);
msgs::part_state ToMessage(const engine::PartSnapshot& snapshot, const engine::Machine& machine);
msgs::histogram ToMessage(const engine::Histogram& histogram);
msgs::engine_state ToMessage(const engine::EngineFigures& figures, const engine::Machine& machine);
// Client, session and id stay empty.
msgs::feedback ToMessage(const FeedbackEvent& event);
msgs::journal_command ToMessage(const engine::JournalEntry& entry, const engine::Machine& machine);
msgs::drive_setpoint ToMessage(const engine::DriveSetPoint& set_point, const engine::Machine& machine);
// Plant stays empty, too.
msgs::drive_feedback ToMessage(const engine::DriveSample& sample, const engine::Machine& machine);
msgs::journal_drive ToMessage(const engine::DriveEntry& entry, const engine::Machine& machine);
// Axis, plant and sequence of the message are ignored.
engine::DriveSample ToSample(const msgs::drive_feedback& message, std::uint32_t axis);

// Decode arbitrary bytes from the network; return nothing if they are no valid message of this type. The generated
// decode() alone is not safe here: a negative string length makes it throw or read beyond the end.
std::optional<msgs::command> DecodeCommand(std::span<const std::uint8_t> bytes);
std::optional<msgs::heartbeat> DecodeHeartbeat(std::span<const std::uint8_t> bytes);
std::optional<msgs::machine_description> DecodeMachine(std::span<const std::uint8_t> bytes);
std::optional<msgs::drive_feedback> DecodeDriveFeedback(std::span<const std::uint8_t> bytes);

// Encodes into `buffer`, whose memory is reused from message to message.
template <typename Message>
void Encode(const Message& message, std::vector<std::uint8_t>& buffer) {
  const int size = message.getEncodedSize();
  buffer.resize(static_cast<std::size_t>(size));
  message.encode(buffer.data(), 0, size);
}

}  // namespace takt::lcm
