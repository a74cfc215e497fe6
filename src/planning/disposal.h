#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

namespace casepush {

/// Frees what takes long to free in a thread of its own, so that nobody has to wait for it.
/// Thread-safe. Its end waits until all is freed.
class Disposal {
 public:
  Disposal() = default;
  ~Disposal();
  Disposal(const Disposal&) = delete;
  Disposal& operator=(const Disposal&) = delete;

  /// Nothing happens if others own it as well: the last of them will free it.
  /// @param garbage  Refers to nothing any more that its destructor needs; does not own this.
  void take(std::shared_ptr<const void> garbage);

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<const void>> garbage_;
  bool is_ending_ = false;
  std::thread thread_;  // From the first time that there is something to free.
};

}  // namespace casepush
