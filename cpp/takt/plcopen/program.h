// Cyclic programs in C++ made of function blocks, in virtual or in real time:
//
//   plcopen::Program program(engine);
//   plcopen::MC_Power power(program.Axis("x"));
//   plcopen::MC_MoveAbsolute move(program.Axis("x"));
//
//   const auto scan = [&] {
//     program.Update();
//     power.Enable = true;
//     power();
//     move.position = 100;
//     move.Execute = power.Status();
//     move();
//   };
//   for (;;) scan(), engine.RunCycle();                  // virtual time, or
//   Run(engine, {.program = scan}, signals);             // real time, in the cycle's own thread
//
// takt/plcopen/blocks.h has all blocks. Blocks and the program must be made before the cycle runs, and be used only by
// the thread that runs it; calling them never allocates, locks or throws. Blocks must not outlive their program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "takt/axis/outputs.h"
#include "takt/engine/engine.h"
#include "takt/group/outputs.h"

namespace takt::plcopen {

class Feedback;
class Program;

// A component of the program's machine.
class ComponentRef {
 public:
  ComponentRef(Program& program, std::uint32_t target) : program_(&program), target_(target) {}

  Program& program() const noexcept { return *program_; }
  std::uint32_t target() const noexcept { return target_; }

 private:
  Program* program_;
  std::uint32_t target_;
};

class AxisRef : public ComponentRef {
 public:
  using ComponentRef::ComponentRef;
  // As of the last cycle.
  const axis::Outputs& outputs() const noexcept;
};

class GroupRef : public ComponentRef {
 public:
  GroupRef(Program& program, std::uint32_t target, std::uint32_t index)
      : ComponentRef(program, target), index_(index) {}
  // As of the last cycle.
  const group::Outputs& outputs() const noexcept;
  // The parameters of the machine file.
  const group::GroupParams& params() const noexcept;

 private:
  std::uint32_t index_;  // index among the groups
};

// Passes the engine's feedback on commands to the blocks that gave them. It is the only consumer of the engine's
// feedback and the only producer of its commands: one program per engine, and not together with an LCM service.
class Program {
 public:
  explicit Program(engine::Engine& engine) : engine_(engine) {}
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // Returns the axis of this name. Throws std::invalid_argument if the machine has none.
  AxisRef Axis(std::string_view name);
  // Returns the group of this name. Throws std::invalid_argument if the machine has none.
  GroupRef Group(std::string_view name);
  engine::Engine& engine() noexcept { return engine_; }

  // Returns true if every axis of the machine was Disabled in the last cycle.
  bool AllDisabled() const noexcept;

  // Must be called once per cycle, before the blocks.
  void Update() noexcept;

 private:
  friend class Feedback;

  struct Waiting {
    Ticket ticket;
    Feedback* feedback;
  };
  std::vector<Waiting>::iterator Find(Ticket ticket) noexcept;
  void Add(Ticket ticket, Feedback& feedback) noexcept;
  void Remove(Ticket ticket) noexcept;

  engine::Engine& engine_;
  std::size_t feedbacks_ = 0;     // number of feedbacks; each has one command at most
  std::vector<Waiting> waiting_;  // sorted by ticket
};

}  // namespace takt::plcopen
