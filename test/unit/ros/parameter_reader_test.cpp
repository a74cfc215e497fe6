#include "casepush/ros/parameter_reader.h"

#include <gtest/gtest.h>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

using XmlRpc::XmlRpcValue;

std::string problems(const ParameterReader& reader) {
  try {
    reader.finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ParameterReader, leavesDefaultsWhereNothingIsGiven) {
  ParameterReader reader(XmlRpcValue(), "node");
  double number = 1.5;
  int integer = 3;
  std::string word = "metric";
  reader.read("a", number, 0, 2);
  reader.read("b", integer, 0, 5);
  reader.read("c", word, {"metric", "paper"});
  EXPECT_EQ(problems(reader), "");
  EXPECT_DOUBLE_EQ(number, 1.5);
  EXPECT_EQ(integer, 3);
  EXPECT_EQ(word, "metric");
}

TEST(ParameterReader, readsEachTypeAndGroups) {
  XmlRpcValue values;
  values["whole_as_number"] = 2;
  values["flag"] = true;
  values["seed"] = 7;
  values["group"]["inner"] = 0.25;
  values["word"] = std::string("paper");
  ParameterReader reader(values, "node");
  double number = 0;
  double inner = 0;
  bool flag = false;
  std::uint64_t seed = 0;
  std::string word = "metric";
  reader.read("whole_as_number", number);
  reader.read("group/inner", inner, 0, 1);
  reader.read("flag", flag);
  reader.read("seed", seed);
  reader.read("word", word, {"metric", "paper"});
  EXPECT_EQ(problems(reader), "");
  EXPECT_DOUBLE_EQ(number, 2.0);
  EXPECT_DOUBLE_EQ(inner, 0.25);
  EXPECT_TRUE(flag);
  EXPECT_EQ(seed, 7U);
  EXPECT_EQ(word, "paper");
}

TEST(ParameterReader, tellsAllViolationsInOneMessage) {
  XmlRpcValue values;
  values["text"] = std::string("fast");
  values["range"] = 3.0;
  values["integer"] = 1.5;
  values["seed"] = -1;
  values["flag"] = 1;
  values["word"] = std::string("nonsense");
  values["typo"] = 1;
  values["group"]["typo"] = 1;
  ParameterReader reader(values, "my_node");
  double number = 0;
  int integer = 0;
  std::uint64_t seed = 0;
  bool flag = false;
  std::string word = "metric";
  reader.read("text", number, 0, 2);
  reader.read("range", number, 0, 2);
  reader.read("integer", integer, 0, 5);
  reader.read("seed", seed);
  reader.read("flag", flag);
  reader.read("word", word, {"metric", "paper"});
  reader.read("group/known", number);
  const std::string text = problems(reader);
  EXPECT_TRUE(contains(text, "my_node")) << text;
  EXPECT_TRUE(contains(text, "text is fast, must be a number in [0, 2]")) << text;
  EXPECT_TRUE(contains(text, "range is 3")) << text;
  EXPECT_TRUE(contains(text, "integer is 1.5, must be an integer in [0, 5]")) << text;
  EXPECT_TRUE(contains(text, "seed is -1")) << text;
  EXPECT_TRUE(contains(text, "flag is 1, must be true or false")) << text;
  EXPECT_TRUE(contains(text, "word is 'nonsense', must be one of metric, paper")) << text;
  EXPECT_TRUE(contains(text, "unknown parameter typo")) << text;
  EXPECT_TRUE(contains(text, "unknown parameter group/typo")) << text;
  EXPECT_FALSE(contains(text, "\n")) << text;
}

TEST(ParameterReader, refusesValueWhereAGroupIsExpected) {
  XmlRpcValue values;
  values["group"] = 3;
  ParameterReader reader(values, "node");
  double number = 0;
  reader.read("group/inner", number);
  EXPECT_TRUE(contains(problems(reader), "unknown parameter group"));
}

TEST(ParameterReader, collectsErrorsOfChecks) {
  ParameterReader reader(XmlRpcValue(), "node");
  reader.check([] { throw InputError("options", "are wrong"); });
  EXPECT_TRUE(contains(problems(reader), "options: are wrong"));
}

}  // namespace
}  // namespace casepush
