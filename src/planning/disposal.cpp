#include "disposal.h"

#include <utility>

namespace casepush {

Disposal::~Disposal() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Disposal::take(std::shared_ptr<const void> garbage) {
  if (garbage.use_count() > 1) return;  // To wake a thread takes long, too.
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    garbage_.push_back(std::move(garbage));
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  }
  changed_.notify_one();
}

void Disposal::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_ending_ || !garbage_.empty(); });
    if (garbage_.empty()) return;
    std::shared_ptr<const void> next = std::move(garbage_.front());
    garbage_.pop_front();
    lock.unlock();
    next.reset();
    lock.lock();
  }
}

}  // namespace casepush
