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
// takt/plcopen/blocks.h has all blocks. Blocks and the program are for the thread that runs the cycle and are made
// before it does; calling them allocates, locks and throws nothing. Blocks must not outlive their program.
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

// One component of the program's machine.
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
  // What the machine file says of it.
  const group::GroupParams& params() const noexcept;

 private:
  std::uint32_t index_;  // among the groups
};

// Hands what the engine says of commands to the blocks that gave them. It is the one consumer of the engine's feedback
// and its one producer of commands, so there is one program an engine, and none beside an LCM service.
class Program {
 public:
  explicit Program(engine::Engine& engine) : engine_(engine) {}
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // Throws std::invalid_argument: the machine has no such axis.
  AxisRef Axis(std::string_view name);
  // The same: no such group.
  GroupRef Group(std::string_view name);
  engine::Engine& engine() noexcept { return engine_; }

  // Every axis of the machine is in Disabled, as of the last cycle.
  bool AllDisabled() const noexcept;

  // To be called once a cycle, before the blocks.
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
  std::size_t feedbacks_ = 0;     // that there are; each has one command at most
  std::vector<Waiting> waiting_;  // by ticket
};

}  // namespace takt::plcopen
