#include "takt/cam/builder.h"

#include <memory>
#include <utility>
#include <vector>

#include "takt/cam/build.h"
#include "takt/core/problem.h"

namespace takt::cam {

namespace {

void FreeRetired(BuildQueues& queues) {
  for (Table* table = nullptr; queues.retired.TryPop(table);) delete table;
}

std::string SentenceOf(const std::string& name, const std::vector<Finding>& errors) {
  const Finding& first = errors.front();
  std::string sentence = "cam " + Quoted(name) + ": " + (first.path.empty() ? "" : first.path + ": ") + first.message;
  if (errors.size() > 1) sentence += " (and " + std::to_string(errors.size() - 1) + " more)";
  return sentence;
}

}  // namespace

BuildQueues::~BuildQueues() {
  FreeRetired(*this);
  for (BuiltTable one; built.TryPop(one);) delete one.table;
}

std::optional<BuildResult> BuildNext(BuildQueues& queues) {
  FreeRetired(queues);
  BuildRequest request;
  if (!queues.requests.TryPop(request)) return std::nullopt;
  BuildResult result{request.ticket, {request.number, false}, {}};
  Built built = Build(*request.draft);
  if (!built.table) {
    result.sentence = SentenceOf(request.draft->name, built.errors);
    return result;
  }
  auto table = std::make_unique<Table>(std::move(*built.table));
  result.built.good = queues.built.TryPush({request.number, table.get()});
  if (result.built.good) static_cast<void>(table.release());  // the cycle owns it now
  return result;
}

}  // namespace takt::cam
