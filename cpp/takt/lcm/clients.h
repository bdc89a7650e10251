// All that is known about clients and their commands: who is alive, which id became which ticket, what was answered
// last (EN-22, EN-23). No LCM in here. Every method may be called from any thread; none of them is the cycle's.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "takt/engine/command.h"
#include "takt/engine/machine.h"
#include "takt/engine/path_checks.h"
#include "takt/lcm/messages.h"

namespace takt::lcm {

struct ClientLimits {
  std::size_t clients = 64;               // more are guests while all of these are alive
  std::size_t guests = 64;                // senders without a place of whom the stops are remembered
  std::size_t ids_per_client = 1024;      // remembered; more unfinished ones are refused ...
  std::size_t stops_per_client = 64;      // ... but for so many that stop something
  std::size_t replies = 1 << 14;          // waiting to be published; more are dropped and counted
  std::size_t arguments = 1 << 16;        // bytes of a command's arguments
  std::int64_t alive_ns = 2'000'000'000;  // after the last sign of life; then the name is free for another session
};

struct ClientFigures {
  std::uint64_t malformed = 0;
  std::uint64_t ignored = 0;    // commands and heartbeats that came too late
  std::uint64_t other_run = 0;  // likewise, for another start of the engine
  std::uint64_t replies_dropped = 0;
  std::uint32_t alive = 0;  // clients
};

class Clients {
 public:
  // Hands a command to the engine: its ticket, or 0 if the queue is full. Called by one thread at a time.
  using Submit = std::function<Ticket(const engine::Command&)>;

  // What is wrong, for people; empty: nothing.
  using Explain = std::function<std::string(const FeedbackEvent&)>;

  // `machine` must outlive this. Commands and heartbeats with another `run_id` are refused.
  Clients(const engine::Machine& machine, std::int64_t run_id, Submit submit, const ClientLimits& limits = {},
          Explain explain = engine::Sentence);

  std::int64_t run_id() const { return run_id_; }

  // From the network. `now_ns` is the monotonic clock; `age_ns`: how long ago the message was given.
  // A command that is too old is refused (EN-33). One that stops something, releases it or switches it off is taken
  // whatever the state of its sender (EN-32): too old, without a place among the clients, under another's name.
  void OnCommand(const msgs::command& message, std::int64_t now_ns, std::int64_t age_ns = 0);
  // Renews the lease of each of the client's level-sensitive commands. Answered (with id 0) only if it is refused. One
  // that is older than the lease renews nothing.
  void OnHeartbeat(const msgs::heartbeat& message, std::int64_t now_ns, std::int64_t age_ns = 0);
  void OnMalformed();

  // From the engine.
  void OnFeedback(const FeedbackEvent& event);

  // The next reply to publish. False: none.
  bool TakeReply(msgs::feedback& reply);

  ClientFigures figures(std::int64_t now_ns) const;

 private:
  struct Record {
    msgs::feedback last;  // what was answered last
    bool level_sensitive = false;
    bool stays_in_force = false;  // after its end, until released
  };
  struct Client {
    std::int64_t session = 0;
    std::int64_t last_seen_ns = 0;
    std::int64_t forgotten_id = 0;  // ids up to this one that are not remembered were given, or may have been
    std::unordered_map<std::int64_t, Record> records;
    std::deque<std::int64_t> order;       // ids of the records, the oldest first
    std::vector<Ticket> level_sensitive;  // those that heartbeats keep alive
  };
  // A client's name and session.
  using Sender = std::pair<std::string, std::int64_t>;
  struct Origin {
    Client* client;
    std::int64_t id;
  };

  // It comes from a sender that has a name, for this start of the engine. False: `refusal` says why not. `Message`:
  // command or heartbeat.
  template <typename Message>
  bool IsForUs(const Message& message, msgs::feedback& refusal);
  // The client of this name and session, made if there is room, seen alive now. Null, and `refusal` says why, if there
  // is no place for it.
  template <typename Message>
  Client* Admit(const Message& message, std::int64_t now_ns, msgs::feedback& refusal);
  // A sender without a place, which may only let go. The one without news for longest makes room.
  Client* Guest(const Sender& sender, std::int64_t now_ns);
  // What is known of a sender that becomes `client`: as a guest, if it was one; its unfinished commands are of `client`
  // from now on.
  Client FormerGuest(const Sender& sender, Client& client);
  bool MakeRoomForClient(std::int64_t now_ns);
  bool MakeRoomForId(Client& client, bool lets_go);
  void Forget(Client& client);
  // After a release of this ticket by any client: no heartbeat keeps it in force any more once it is final. Until
  // then it is still on its way.
  void LetGo(Ticket ticket);
  engine::ParsedCommand Parse(const msgs::command& message) const;
  // Hands the command on, or makes `reply` a refusal.
  void Give(Client& client, const msgs::command& message, const engine::ParsedCommand& parsed, std::int64_t expires_ns,
            msgs::feedback& reply);
  void Reply(const msgs::feedback& reply);

  const engine::Machine& machine_;
  const std::int64_t run_id_;
  const Submit submit_;
  const Explain explain_;
  const ClientLimits limits_;

  mutable std::mutex mutex_;
  std::map<std::string, Client> clients_;
  std::map<Sender, Client> guests_;
  std::unordered_map<Ticket, Origin> origins_;  // of tickets that are not final
  std::deque<msgs::feedback> replies_;
  std::uint64_t malformed_ = 0;
  std::uint64_t ignored_ = 0;
  std::uint64_t other_run_ = 0;
  std::uint64_t replies_dropped_ = 0;
};

}  // namespace takt::lcm
