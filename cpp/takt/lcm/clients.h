// The state of clients and their commands: which clients are alive, which id became which ticket, and the last reply to
// each (EN-22, EN-23). Independent of LCM. Every method is thread-safe; none may be called by the cycle.
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
  std::size_t clients = 64;               // further senders are guests while all of these are alive
  std::size_t guests = 64;                // senders beyond `clients` whose stops are remembered
  std::size_t ids_per_client = 1024;      // remembered; further unfinished ones are refused ...
  std::size_t stops_per_client = 64;      // ... except this many commands that stop something
  std::size_t replies = 1 << 14;          // waiting to be published; further ones are dropped and counted
  std::size_t arguments = 1 << 16;        // [bytes] of a command's arguments
  std::int64_t alive_ns = 2'000'000'000;  // [ns] after the last sign of life; then the name is free for another session
};

struct ClientFigures {
  std::uint64_t malformed = 0;
  std::uint64_t ignored = 0;    // commands and heartbeats that arrived too late
  std::uint64_t other_run = 0;  // likewise, for another run of the engine
  std::uint64_t replies_dropped = 0;
  std::uint32_t alive = 0;  // clients
};

class Clients {
 public:
  // Hands a command to the engine; returns its ticket, or 0 if the queue is full. Called by one thread at a time.
  using Submit = std::function<Ticket(const engine::Command&)>;

  // Returns what is wrong, for users; empty if nothing is.
  using Explain = std::function<std::string(const FeedbackEvent&)>;

  // `machine` must outlive this object. Commands and heartbeats with another `run_id` are refused.
  Clients(const engine::Machine& machine, std::int64_t run_id, Submit submit, const ClientLimits& limits = {},
          Explain explain = engine::Sentence);

  std::int64_t run_id() const { return run_id_; }

  // From the network. `now_ns`: monotonic clock; `age_ns`: time since the message was sent.
  // A command that is too old is refused (EN-33). A command that stops something, releases it or switches it off is
  // accepted regardless of its sender (EN-32): too old, beyond the number of clients, or under another client's name.
  void OnCommand(const msgs::command& message, std::int64_t now_ns, std::int64_t age_ns = 0);
  // Renews the lease of each of the client's level-sensitive commands. A reply (with id 0) is only sent if it is
  // refused. A heartbeat that is older than the lease renews nothing.
  void OnHeartbeat(const msgs::heartbeat& message, std::int64_t now_ns, std::int64_t age_ns = 0);
  void OnMalformed();

  // From the engine.
  void OnFeedback(const FeedbackEvent& event);

  // Takes the next reply to publish. Returns false if there is none.
  bool TakeReply(msgs::feedback& reply);

  ClientFigures figures(std::int64_t now_ns) const;

 private:
  struct Record {
    msgs::feedback last;  // last reply
    bool level_sensitive = false;
    bool stays_in_force = false;  // after its end, until it is released
  };
  struct Client {
    std::int64_t session = 0;
    std::int64_t last_seen_ns = 0;
    std::int64_t forgotten_id = 0;  // ids up to this one that have no record were used, or may have been
    std::unordered_map<std::int64_t, Record> records;
    std::deque<std::int64_t> order;       // ids of the records, oldest first
    std::vector<Ticket> level_sensitive;  // commands that heartbeats keep in force
  };
  // Name and session of a client.
  using Sender = std::pair<std::string, std::int64_t>;
  struct Origin {
    Client* client;
    std::int64_t id;
  };

  // Returns true if the message (command or heartbeat) has a valid client name and is for this run of the engine;
  // otherwise `refusal` says why not.
  template <typename Message>
  bool IsForUs(const Message& message, msgs::feedback& refusal);
  // Returns the client of this name and session, added if there is room, and marks it as alive. Null, and `refusal`
  // says why, if it cannot be added.
  template <typename Message>
  Client* Admit(const Message& message, std::int64_t now_ns, msgs::feedback& refusal);
  // Returns the entry of a sender beyond the number of clients, which may only stop or release. The one that was silent
  // for longest makes room.
  Client* Guest(const Sender& sender, std::int64_t now_ns);
  // Returns the entry of a sender that becomes `client`, including its history as a guest; its unfinished commands then
  // belong to `client`.
  Client FormerGuest(const Sender& sender, Client& client);
  bool MakeRoomForClient(std::int64_t now_ns);
  bool MakeRoomForId(Client& client, bool lets_go);
  void Forget(Client& client);
  // Called for a release of this ticket by any client: heartbeats no longer keep the command in force once it is final.
  // Until then they still do.
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
