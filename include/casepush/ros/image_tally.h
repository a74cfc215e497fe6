#pragma once

#include <map>
#include <string>

namespace casepush {

/// How often and how late the cameras' images come.
class ImageTally {
 public:
  /// @param stamp_s, now_s  When the image was taken, and when it was worked on.
  void add(const std::string& frame_id, double stamp_s, double now_s);

  /// Whether images came too seldom or too late for pushing since the last call, in one line;
  /// empty: they did not.
  std::string complaint();

 private:
  struct Camera {
    double last_s = 0.0;  ///< Stamp of the latest image.
    double sum_s = 0.0;   ///< Of the intervals between the images.
    int intervals = 0;
    double latest_s = 0.0;  ///< The longest delay.
  };
  std::map<std::string, Camera> cameras_;
};

}  // namespace casepush
