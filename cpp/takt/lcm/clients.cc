#include "takt/lcm/clients.h"

#include <algorithm>
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

// A held stop is done when what it stops stands, and in force until it is released.
bool StaysInForce(const engine::Command& command) {
  return IsHeldStop<axis::Stop, axis::Command>(command.body) || IsHeldStop<group::Stop, group::Command>(command.body);
}

// The ticket that a release lets go of; 0: it is no release.
Ticket Released(const engine::Command& command) {
  const auto* machine = std::get_if<engine::MachineCommand>(&command.body);
  const auto* release = machine ? std::get_if<engine::Release>(machine) : nullptr;
  return release ? release->ticket : 0;
}

bool IsFinalReply(const msgs::feedback& reply) {
  return IsFinal(static_cast<FeedbackState>(reply.state));
}

}  // namespace

Clients::Clients(const engine::Machine& machine, std::int64_t run_id, Submit submit, const ClientLimits& limits,
                 Explain explain)
    : machine_(machine), run_id_(run_id), submit_(std::move(submit)), explain_(std::move(explain)), limits_(limits) {}

template <typename Message>
Clients::Client* Clients::Admit(const Message& message, std::int64_t now_ns, msgs::feedback& refusal) {
  const std::string& name = message.client;
  const std::int64_t session = message.session;
  if (!IsGoodName(name)) {
    Refuse(refusal, ErrorId::kParameter,
           "client: expected a name of 1 to " + std::to_string(kLongestName) + " printable ASCII characters");
    return nullptr;
  }
  if (message.run_id != run_id_) {
    Refuse(refusal, ErrorId::kOtherRun, std::string(ErrorText(ErrorId::kOtherRun)));
    return nullptr;
  }
  auto found = clients_.find(name);
  if (found == clients_.end()) {
    if (!MakeRoomForClient(now_ns)) {
      Refuse(refusal, ErrorId::kQueueFull, "there are " + std::to_string(limits_.clients) + " clients already");
      return nullptr;
    }
    found = clients_.try_emplace(name).first;
    found->second.session = session;
  }
  Client& client = found->second;
  if (client.session != session) {
    if (now_ns - client.last_seen_ns <= limits_.alive_ns) {
      Refuse(refusal, ErrorId::kClientName,
             "another client uses the name " + name + "; take another one, or wait 2 s after it has gone");
      return nullptr;
    }
    Forget(client);
    client = {};
    client.session = session;
  }
  client.last_seen_ns = now_ns;
  return &client;
}

void Clients::OnCommand(const msgs::command& message, std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  msgs::feedback reply = EmptyReply(message.client, message.session, message.id);
  Client* client = Admit(message, now_ns, reply);
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
  Give(*client, message, reply);
  if (IsFinalReply(reply)) Reply(reply);  // what was accepted is answered by the cycle
}

void Clients::Give(Client& client, const msgs::command& message, msgs::feedback& reply) {
  if (!MakeRoomForId(client)) {
    client.forgotten_id = std::max(client.forgotten_id, message.id);
    return Refuse(reply, ErrorId::kQueueFull,
                  std::to_string(limits_.ids_per_client) + " commands of this client are not finished yet");
  }
  engine::ParsedCommand parsed;
  if (message.arguments.size() > limits_.arguments) {
    Refuse(reply, ErrorId::kParameter, "arguments are longer than " + std::to_string(limits_.arguments) + " bytes");
  } else if (parsed = engine::ParseCommand(machine_, message.target, message.verb, message.arguments);
             parsed.error != ErrorId::kNone) {
    Refuse(reply, parsed.error, parsed.sentence);
  } else {
    if (parsed.level_sensitive) parsed.command.lease_s = machine_.lcm.dead_man_s;
    // The lock is held from here to the entry in origins_: the answer may come before submit_ returns.
    const Ticket ticket = submit_(parsed.command);
    if (ticket == 0) {
      Refuse(reply, ErrorId::kQueueFull, std::string(ErrorText(ErrorId::kQueueFull)));
    } else {
      reply.ticket = static_cast<std::int64_t>(ticket);
      origins_[ticket] = {&client, message.id};
      if (parsed.level_sensitive) client.level_sensitive.push_back(ticket);
      LetGo(Released(parsed.command));
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
  }
}

void Clients::OnHeartbeat(const msgs::heartbeat& message, std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  msgs::feedback reply = EmptyReply(message.client, message.session, 0);
  Client* client = Admit(message, now_ns, reply);
  if (client == nullptr) return Reply(reply);
  for (const Ticket ticket : client->level_sensitive) {
    // A full queue is no harm: the next heartbeat tries again.
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
  if (found == origins_.end()) return;  // a renewal, or of a session that is gone
  const auto [client, id] = found->second;
  Record& record = client->records.at(id);
  msgs::feedback reply = ToMessage(event);
  reply.sentence = explain_(event);
  reply.client = record.last.client;
  reply.session = record.last.session;
  reply.id = id;
  record.last = reply;
  if (IsFinal(event.state)) {
    const bool in_force = record.stays_in_force && event.state == FeedbackState::kDone;
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
  return {malformed_, replies_dropped_, static_cast<std::uint32_t>(alive)};
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

bool Clients::MakeRoomForId(Client& client) {
  if (client.records.size() < limits_.ids_per_client) return true;
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
