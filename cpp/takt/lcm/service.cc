#include "takt/lcm/service.h"

#include <optional>
#include <utility>

namespace takt::lcm {

Service::Service(engine::Engine& engine, const ServiceOptions& options)
    : authentication_(options.authentication),
      clients_(
          engine.machine(), options.info.run_id,
          [&engine](const engine::Command& command) { return engine.Submit(command); }, {}, options.explain) {}

std::unique_ptr<Service> Service::Open(engine::Engine& engine, const ServiceOptions& options, std::string& problem) {
  std::unique_ptr<Service> service(new Service(engine, options));
  if (!options.url.empty()) {
    service->sending_ = OpenNetwork(options.url);
    problem = service->sending_.problem;
    if (service->sending_.lcm) service->receiving_ = OpenReceiver(options.url, problem);
    if (!service->receiving_) return nullptr;
    std::optional<Key> own;
    if (Authentication* const authentication = options.authentication.get()) {
      own = authentication->keys().own;
      service->receiving_ = WithKey(
          std::move(service->receiving_), authentication->keys(),
          [authentication](std::string_view channel, TagState state) { authentication->Refuse(channel, state); });
    }
    service->network_ = std::make_unique<NetworkOutlet>(*service->sending_.lcm, own);
  }
  if (!options.log_path.empty()) {
    service->log_ = OpenLog(options.log_path, problem);
    if (!service->log_) return nullptr;
  }
  service->publisher_ = std::make_unique<Publisher>(engine, service->clients_, service->network_.get(),
                                                    service->log_.get(), options.info, options.authentication.get());
  if (service->receiving_) service->gateway_ = std::make_unique<Gateway>(*service->receiving_, service->clients_);
  return service;
}

Losses Service::Close() {
  gateway_.reset();
  publisher_->Stop();
  Losses losses{.messages = publisher_->send_failures()};
  if (log_) {
    log_->Flush();
    losses.log = log_->failed();
    log_.reset();
  }
  return losses;
}

}  // namespace takt::lcm
