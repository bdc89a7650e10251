#include "takt/lcm/service.h"

namespace takt::lcm {

Service::Service(engine::Engine& engine)
    : clients_(engine.machine(), [&engine](const engine::Command& command) { return engine.Submit(command); }) {}

std::unique_ptr<Service> Service::Open(engine::Engine& engine, const ServiceOptions& options, std::string& problem) {
  std::unique_ptr<Service> service(new Service(engine));
  if (!options.url.empty()) {
    service->sending_ = OpenNetwork(options.url);
    if (service->sending_.lcm) service->receiving_ = OpenNetwork(options.url);
    problem = service->sending_.problem + service->receiving_.problem;
    if (!problem.empty()) return nullptr;
    service->network_ = std::make_unique<NetworkOutlet>(*service->sending_.lcm);
  }
  if (!options.log_path.empty()) {
    service->log_ = std::make_unique<LogOutlet>(options.log_path);
    if (!service->log_->good()) {
      problem = "log file " + options.log_path + " cannot be written";
      return nullptr;
    }
  }
  service->publisher_ = std::make_unique<Publisher>(engine, service->clients_, service->network_.get(),
                                                    service->log_.get(), options.info);
  if (service->receiving_.lcm)
    service->gateway_ = std::make_unique<Gateway>(*service->receiving_.lcm, service->clients_);
  return service;
}

std::uint64_t Service::Close() {
  gateway_.reset();
  publisher_->Stop();
  log_.reset();
  return publisher_->send_failures();
}

}  // namespace takt::lcm
