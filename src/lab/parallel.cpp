#include "parallel.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace casepush {

void forEachIndex(int count, int jobs, const std::function<void(int)>& work) {
  std::mutex mutex;
  int next = 0;
  std::exception_ptr error;
  const auto drain = [&] {
    while (true) {
      int index = 0;
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (next >= count || error) {
          return;
        }
        index = next++;
      }
      try {
        work(index);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        error = error ? error : std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < std::min(jobs, count); ++i) {
    threads.emplace_back(drain);
  }
  drain();
  for (std::thread& thread : threads) {
    thread.join();
  }
  if (error) {
    std::rethrow_exception(error);
  }
}

}  // namespace casepush
