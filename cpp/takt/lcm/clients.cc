#include "takt/lcm/clients.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace takt::lcm {
namespace {

constexpr std::size_t kLongestName = 64;
constexpr std::size_t kLongestSentence = 500;

bool IsGoodName(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName &&
         std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

void Refuse(msgs::feedback& reply, ErrorId error, std::string sentence) {
  if (sentence.size() > kLongestSentence) {
    std::size_t end = kLongestSentence;
    while (end > 0 && (static_cast<unsigned char>(sentence[end]) & 0xC0) == 0x80)
      --end;  // not inside a UTF-8 character
    sentence.resize(end);
    sentence += " ...";
  }
  reply.state = static_cast<std::int8_t>(FeedbackState::kError);
  reply.error_id = static_cast<std::int32_t>(error);
  reply.sentence = std::move(sentence);
}

msgs::feedback EmptyReply(const std::string& client, std::int64_t session, std::int64_t id) {
  msgs::feedback reply{};
  reply.client = client.substr(0, kLongestName);
  reply.session = session;
  reply.id = id;
  reply.cycle = -1;
  return reply;
}

template <typename Stop, typename OfComponent>
bool IsHeldStop(const engine::CommandBody& body) {
  const auto* command = std::get_if<OfComponent>(&body);
  const auto* stop = command ? std::get_if<Stop>(command) : nullptr;
  return stop && stop->hold;
}

// A held stop is done when its component is at rest, and in force until it is released.
bool StaysInForce(const engine::Command& command) {
  return IsHeldStop<axis::Stop, axis::Command>(command.body) || IsHeldStop<group::Stop, group::Command>(command.body);
}

// Returns the ticket that a release refers to; 0 if the command is no release.
Ticket Released(const engine::Command& command) {
  const auto* machine = std::get_if<engine::MachineCommand>(&command.body);
  const auto* release = machine ? std::get_if<engine::Release>(machine) : nullptr;
  return release ? release->ticket : 0;
}

bool IsFinalReply(const msgs::feedback& reply) {
  return IsFinal(static_cast<FeedbackState>(reply.state));
}

// Returns true if a held stop still holds after its final feedback, however it ended: power off, a fault or another
// stop ends the command but not the hold. A stop that never took control holds nothing, nor does one that found no room
// (kBufferFull).
bool Holds(const FeedbackEvent& end, const msgs::feedback& before) {
  const bool began = static_cast<FeedbackState>(before.state) == FeedbackState::kActive;
  return end.state == FeedbackState::kDone || (began && end.error != ErrorId::kBufferFull);
}

}  // namespace

Clients::Clients(const engine::Machine& machine, std::int64_t run_id, Submit submit, const ClientLimits& limits,
                 Explain explain)
    : machine_(machine), run_id_(run_id), submit_(std::move(submit)), explain_(std::move(explain)), limits_(limits) {}

template <typename Message>
bool Clients::IsForUs(const Message& message, msgs::feedback& refusal) {
  if (!IsGoodName(message.client)) {
    Refuse(refusal, ErrorId::kParameter,
           "client: expected a name of 1 to " + std::to_string(kLongestName) + " printable ASCII characters");
    return false;
  }
  if (message.run_id != run_id_) {
    ++other_run_;
    Refuse(refusal, ErrorId::kOtherRun, std::string(ErrorText(ErrorId::kOtherRun)));
    return false;
  }
  return true;
}

template <typename Message>
Clients::Client* Clients::Admit(const Message& message, std::int64_t now_ns, msgs::feedback& refusal) {
  const std::string& name = message.client;
  const std::int64_t session = message.session;
  auto found = clients_.find(name);
  if (found == clients_.end()) {
    if (!MakeRoomForClient(now_ns)) {
      Refuse(refusal, ErrorId::kQueueFull, "there are " + std::to_string(limits_.clients) + " clients already");
      return nullptr;
    }
    found = clients_.try_emplace(name).first;
    found->second = FormerGuest({name, session}, found->second);
  }
  Client& client = found->second;
  if (client.session != session) {
    if (now_ns - client.last_seen_ns <= limits_.alive_ns) {
      Refuse(refusal, ErrorId::kClientName,
             "another client uses the name " + name +
                 "; use another name, or wait 2 s after that client has disconnected");
      return nullptr;
    }
    Forget(client);
    client = FormerGuest({name, session}, client);
  }
  client.last_seen_ns = now_ns;
  return &client;
}

Clients::Client* Clients::Guest(const Sender& sender, std::int64_t now_ns) {
  auto found = guests_.find(sender);
  if (found == guests_.end()) {
    if (guests_.size() >= limits_.guests) {
      const auto oldest = std::min_element(guests_.begin(), guests_.end(), [](const auto& a, const auto& b) {
        return a.second.last_seen_ns < b.second.last_seen_ns;
      });
      Forget(oldest->second);
      guests_.erase(oldest);
    }
    found = guests_.try_emplace(sender).first;
    found->second.session = sender.second;
  }
  found->second.last_seen_ns = now_ns;
  return &found->second;
}

Clients::Client Clients::FormerGuest(const Sender& sender, Client& client) {
  auto guest = guests_.extract(sender);
  if (guest.empty()) {
    Client unknown;
    unknown.session = sender.second;
    return unknown;
  }
  for (auto& [ticket, origin] : origins_) {
    if (origin.client == &guest.mapped()) origin.client = &client;
  }
  return std::move(guest.mapped());
}

engine::ParsedCommand Clients::Parse(const msgs::command& message) const {
  if (message.arguments.size() <= limits_.arguments) {
    return engine::ParseCommand(machine_, message.target, message.verb, message.arguments);
  }
  engine::ParsedCommand refused;
  refused.error = ErrorId::kParameter;
  refused.sentence = "arguments are longer than " + std::to_string(limits_.arguments) + " bytes";
  return refused;
}

void Clients::OnCommand(const msgs::command& message, std::int64_t now_ns, std::int64_t age_ns) {
  const std::lock_guard lock(mutex_);
  msgs::feedback reply = EmptyReply(message.client, message.session, message.id);
  if (!IsForUs(message, reply)) return Reply(reply);
  const engine::ParsedCommand parsed = Parse(message);
  const bool lets_go = parsed.error == ErrorId::kNone && engine::LetsGo(parsed.command);
  Client* client = Admit(message, now_ns, reply);
  if (client == nullptr && lets_go) {
    client = Guest({message.client, message.session}, now_ns);
    reply = EmptyReply(message.client, message.session, message.id);
  }
  if (client == nullptr) return Reply(reply);

  if (const auto known = client->records.find(message.id); known != client->records.end()) {
    return Reply(known->second.last);
  }
  if (message.id < 1) {
    Refuse(reply, ErrorId::kParameter, "id: expected 1 or more, found " + std::to_string(message.id));
    return Reply(reply);
  }
  if (message.id <= client->forgotten_id) {
    Refuse(reply, ErrorId::kParameter,
           "id " + std::to_string(message.id) + " is too old to be known; ids of a session must rise");
    return Reply(reply);
  }
  const auto limit_ns = std::llround(machine_.lcm.command_age_s * 1e9);
  if (age_ns > limit_ns && !lets_go) {
    ++ignored_;
    client->forgotten_id = std::max(client->forgotten_id, message.id);
    std::ostringstream sentence;
    sentence << "the command is " << std::setprecision(3) << static_cast<double>(age_ns) / 1e9
             << " s old, or the clocks of its sender and of the engine differ by that; the limit is "
             << machine_.lcm.command_age_s << " s (lcm.command_age_s)";
    Refuse(reply, ErrorId::kTooOld, sentence.str());
    return Reply(reply);
  }
  Give(*client, message, parsed, now_ns + limit_ns - age_ns, reply);
  if (IsFinalReply(reply)) Reply(reply);  // accepted commands are answered by the cycle
}

void Clients::Give(Client& client, const msgs::command& message, const engine::ParsedCommand& parsed,
                   std::int64_t expires_ns, msgs::feedback& reply) {
  const bool lets_go = parsed.error == ErrorId::kNone && engine::LetsGo(parsed.command);
  if (!MakeRoomForId(client, lets_go)) {
    client.forgotten_id = std::max(client.forgotten_id, message.id);
    return Refuse(reply, ErrorId::kQueueFull,
                  std::to_string(limits_.ids_per_client) + " commands of this client are not finished yet");
  }
  if (parsed.error != ErrorId::kNone) {
    Refuse(reply, parsed.error, parsed.sentence);
  } else {
    engine::Command command = parsed.command;
    command.expires_ns = expires_ns;
    if (parsed.level_sensitive) command.lease_s = machine_.lcm.dead_man_s;
    // The lock is held from here to the entry in origins_: the answer may come before submit_ returns.
    const Ticket ticket = submit_(command);
    if (ticket == 0) {
      Refuse(reply, ErrorId::kQueueFull, std::string(ErrorText(ErrorId::kQueueFull)));
    } else {
      reply.ticket = static_cast<std::int64_t>(ticket);
      origins_[ticket] = {&client, message.id};
      if (parsed.level_sensitive) client.level_sensitive.push_back(ticket);
      LetGo(Released(command));
    }
  }
  client.order.push_back(message.id);
  client.records[message.id] = {reply, parsed.level_sensitive, StaysInForce(parsed.command)};
}

void Clients::LetGo(Ticket ticket) {
  if (const auto running = origins_.find(ticket); running != origins_.end()) {
    running->second.client->records.at(running->second.id).stays_in_force = false;
  } else {
    for (auto& [name, client] : clients_) std::erase(client.level_sensitive, ticket);
    for (auto& [sender, guest] : guests_) std::erase(guest.level_sensitive, ticket);
  }
}

void Clients::OnHeartbeat(const msgs::heartbeat& message, std::int64_t now_ns, std::int64_t age_ns) {
  const std::lock_guard lock(mutex_);
  msgs::feedback reply = EmptyReply(message.client, message.session, 0);
  if (!IsForUs(message, reply)) return Reply(reply);
  if (age_ns > std::llround(machine_.lcm.dead_man_s * 1e9)) {
    ++ignored_;
    return;
  }
  Client* client = Admit(message, now_ns, reply);
  if (client == nullptr) {
    const auto guest = guests_.find({message.client, message.session});
    if (guest == guests_.end()) return Reply(reply);
    client = Guest(guest->first, now_ns);
  }
  for (const Ticket ticket : client->level_sensitive) {
    // A full queue does no harm: the next heartbeat tries again.
    submit_({.target = engine::kMachineTarget, .body = engine::MachineCommand{engine::Renew{ticket}}});
  }
}

void Clients::OnMalformed() {
  const std::lock_guard lock(mutex_);
  ++malformed_;
}

void Clients::OnFeedback(const FeedbackEvent& event) {
  const std::lock_guard lock(mutex_);
  const auto found = origins_.find(event.ticket);
  if (found == origins_.end()) return;  // a renewal, or of an ended session
  const auto [client, id] = found->second;
  Record& record = client->records.at(id);
  msgs::feedback reply = ToMessage(event);
  reply.sentence = explain_(event);
  reply.client = record.last.client;
  reply.session = record.last.session;
  reply.id = id;
  const msgs::feedback before = std::exchange(record.last, reply);
  if (IsFinal(event.state)) {
    const bool in_force = record.stays_in_force && Holds(event, before);
    if (record.level_sensitive && !in_force) std::erase(client->level_sensitive, event.ticket);
    origins_.erase(found);
  }
  Reply(reply);
}

bool Clients::TakeReply(msgs::feedback& reply) {
  const std::lock_guard lock(mutex_);
  if (replies_.empty()) return false;
  reply = std::move(replies_.front());
  replies_.pop_front();
  return true;
}

ClientFigures Clients::figures(std::int64_t now_ns) const {
  const std::lock_guard lock(mutex_);
  const auto alive = std::count_if(clients_.begin(), clients_.end(), [&](const auto& entry) {
    return now_ns - entry.second.last_seen_ns <= limits_.alive_ns;
  });
  return {.malformed = malformed_,
          .ignored = ignored_,
          .other_run = other_run_,
          .replies_dropped = replies_dropped_,
          .alive = static_cast<std::uint32_t>(alive)};
}

bool Clients::MakeRoomForClient(std::int64_t now_ns) {
  if (clients_.size() < limits_.clients) return true;
  const auto oldest = std::min_element(clients_.begin(), clients_.end(), [](const auto& a, const auto& b) {
    return a.second.last_seen_ns < b.second.last_seen_ns;
  });
  if (now_ns - oldest->second.last_seen_ns <= limits_.alive_ns) return false;
  Forget(oldest->second);
  clients_.erase(oldest);
  return true;
}

bool Clients::MakeRoomForId(Client& client, bool lets_go) {
  if (client.records.size() < limits_.ids_per_client) return true;
  if (lets_go && client.records.size() < limits_.ids_per_client + limits_.stops_per_client) return true;
  const auto oldest = std::find_if(client.order.begin(), client.order.end(),
                                   [&](std::int64_t id) { return IsFinalReply(client.records.at(id).last); });
  if (oldest == client.order.end()) return false;
  client.forgotten_id = std::max(client.forgotten_id, *oldest);
  client.records.erase(*oldest);
  client.order.erase(oldest);
  return true;
}

void Clients::Forget(Client& client) {
  std::erase_if(origins_, [&](const auto& entry) { return entry.second.client == &client; });
}

void Clients::Reply(const msgs::feedback& reply) {
  if (replies_.size() < limits_.replies) {
    replies_.push_back(reply);
  } else {
    ++replies_dropped_;
  }
}

}  // namespace takt::lcm
