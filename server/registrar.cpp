#include "server/registrar.h"

#include <algorithm>

#include "daemon/log.h"
#include "server/training.h"

namespace edgepose {
namespace {

constexpr size_t kMaxOrders = 8;

}  // namespace

Registrar::Registrar(Registry& registry, const LiveOptions& options)
    : registry_(registry), options_(options) {
  thread_ = std::thread([this] { run(); });
}

Registrar::~Registrar() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool Registrar::post(Order order) {
  const std::scoped_lock lock(mutex_);
  if (orders_.size() >= kMaxOrders) return false;
  orders_.push_back(std::move(order));
  changed_.notify_all();
  return true;
}

std::vector<std::string> Registrar::pending() const {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> names;
  for (const Order& order : orders_) names.push_back(order.request.name);
  return names;
}

void Registrar::run() {
  while (true) {
    const Order* order = nullptr;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stopping_ || !orders_.empty(); });
      if (stopping_) return;
      order = &orders_.front();  // stays where it is: a deque moves nothing when it grows at its end
    }
    work_on(*order);
    const std::scoped_lock lock(mutex_);
    orders_.pop_front();
  }
}

void Registrar::work_on(const Order& order) {
  const std::string& name = order.request.name;
  TrainingResult result;
  ModelHandle model;
  std::exception_ptr failure;
  try {
    const std::vector<std::string> taken = registry_.names();
    if (!order.replace && std::find(taken.begin(), taken.end(), name) != taken.end())
      throw NameTaken("name: '" + name + "' is registered already; unregister it first, or set replace");
    const auto options = options_.get();
    result = train_in_child(order.request, registry_.incoming(), options->matcher.train, options->training,
                            stopping_);
    model = registry_.add(result.prepared);
    log_event(LogLevel::kInfo, "model_registered",
              {{"model", name}, {"seconds", std::to_string(result.seconds)}, {"file", model->file}});
  } catch (const std::exception& error) {
    failure = std::current_exception();
    log_event(LogLevel::kWarning, "registration_failed", {{"model", name}, {"reason", error.what()}});
  }
  order.done(model, result, failure);
}

}  // namespace edgepose
