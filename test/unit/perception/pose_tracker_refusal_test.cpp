#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/perception/pose_tracker.h"
#include "perception/tag_scene.h"

namespace casepush {
namespace {

std::string errorText(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PoseTracker, refusesSharedTagsNoTagsAndBadOptions) {
  const ObjectModel model = test::taggedObject(2);
  EXPECT_EQ(errorText([&] {
              PoseTracker({{"a", model, 0}, {"b", model, 1}}, {});
            }),
            "b: tag 11 belongs to a too; give each instance a tag_offset of its own");
  EXPECT_EQ(errorText([&] {
              PoseTracker({{"a", model, 0}, {"a", model, 100}}, {});
            }),
            "a: is given twice; object ids must be unique");
  EXPECT_EQ(errorText([&] {
              PoseTracker({{"a", test::taggedObject(0), 0}}, {});
            }),
            "a: object model 'crate' has no tags, so it can not be tracked");
  PoseTrackerOptions options;
  options.reacquire_after = 0;
  options.gate_p_value = std::numeric_limits<double>::quiet_NaN();
  const std::string text = errorText([&] { options.validate(); });
  EXPECT_NE(text.find("gate_p_value is nan, must be in"), std::string::npos) << text;
  EXPECT_NE(text.find("reacquire_after is 0, must be in [1, 1000]"), std::string::npos) << text;
}

}  // namespace
}  // namespace casepush
