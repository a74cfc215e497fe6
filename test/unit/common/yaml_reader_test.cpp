#include "casepush/common/yaml_reader.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <locale>

#include "common/input_error_text.h"
#include "common/temporary_folder.h"

namespace casepush {
namespace {

YamlReader reader(const std::string& text) { return YamlReader::fromText(text, "room.yaml"); }

std::string numberError(const std::string& text) {
  return inputErrorText([&] { reader(text).number("mu", 0, 2); });
}

TEST(YamlReader, readsEveryKind) {
  YamlReader yaml = reader(
      "mu: 0.5\ncount: 3\nname: chair\nempty_is_default: yes\nlist: [1, -2.5, 3e-1, +4]\n"
      "child: {a: 1}\nchildren: [{b: 1}, {b: 2}]\n");
  EXPECT_EQ(yaml.number("mu", 0, 2), 0.5);
  EXPECT_EQ(yaml.integer("count", 0, 5), 3);
  EXPECT_EQ(yaml.text("name"), "chair");
  EXPECT_TRUE(yaml.flag("empty_is_default", false));
  EXPECT_EQ(yaml.numbers("list", -1), (std::vector<double>{1, -2.5, 0.3, 4}));
  YamlReader child = yaml.child("child");
  EXPECT_EQ(child.number("a", 0, 1), 1.0);
  child.finish();
  std::vector<YamlReader> children = yaml.children("children");
  ASSERT_EQ(children.size(), 2U);
  EXPECT_EQ(children[1].integer("b", 0, 9), 2);
  yaml.finish();
}

TEST(YamlReader, readsListsOfTexts) {
  EXPECT_EQ(reader("names: [a, 'b c', 3]").texts("names"),
            (std::vector<std::string>{"a", "b c", "3"}));
  EXPECT_TRUE(reader("other: 1").texts("names").empty());
  EXPECT_EQ(inputErrorText([] { reader("names: a").texts("names"); }),
            "room.yaml: names: must be a list of texts");
  for (const char* text : {"names: [a, '']", "names: [[a]]", "names: [\"a\\nb\"]"}) {
    EXPECT_EQ(inputErrorText([&] { reader(text).texts("names"); }),
              "room.yaml: names: must be a list of non-empty texts on one line each");
  }
}

TEST(YamlReader, fallsBackToDefaultsOnlyForMissingKeys) {
  YamlReader yaml = reader("mu: 5\n");
  EXPECT_EQ(yaml.number("nu", 0, 2, 0.25), 0.25);
  EXPECT_EQ(yaml.integer("n", 0, 2, 1), 1);
  EXPECT_EQ(yaml.text("name", "nobody"), "nobody");
  EXPECT_FALSE(yaml.flag("flag", false));
  EXPECT_FALSE(yaml.optionalChild("child"));
  EXPECT_TRUE(yaml.children("children").empty());
  EXPECT_FALSE(inputErrorText([&] { yaml.number("mu", 0, 2, 0.25); }).empty());
}

TEST(YamlReader, saysWhatIsWrongWithANumber) {
  EXPECT_EQ(numberError("mu: 3"), "room.yaml: mu: is 3; must be a number in [0, 2]");
  EXPECT_EQ(numberError("{}"), "room.yaml: mu: is missing; must be a number in [0, 2]");
  for (const char* text :
       {"mu: much", "mu: [1]", "mu:", "mu: 1.5m", "mu: ''", "mu: 1,5", "mu: .nan"}) {
    EXPECT_EQ(numberError(text), "room.yaml: mu: is not a number; must be a number in [0, 2]")
        << text;
  }
  for (const char* text : {"mu: nan", "mu: inf", "mu: -inf"}) {
    EXPECT_EQ(numberError(text), "room.yaml: mu: is not finite; must be a number in [0, 2]")
        << text;
  }
  EXPECT_FALSE(numberError("mu: 1e999").empty());
  EXPECT_EQ(inputErrorText([] { reader("n: 1.5").integer("n", 0, 2); }),
            "room.yaml: n: must be a whole number");
}

TEST(YamlReader, saysWhatIsWrongWithOtherKinds) {
  EXPECT_EQ(inputErrorText([] { reader("a: [1, nan]").numbers("a", 2); }),
            "room.yaml: a: is not finite; must be a list of 2 finite numbers");
  EXPECT_EQ(inputErrorText([] { reader("a: [1]").numbers("a", 2); }),
            "room.yaml: a: must be a list of 2 finite numbers");
  EXPECT_EQ(inputErrorText([] { reader("a: 1").numbers("a", -1); }),
            "room.yaml: a: must be a list of finite numbers");
  EXPECT_EQ(inputErrorText([] { reader("a: ''").text("a"); }),
            "room.yaml: a: must be a non-empty text");
  EXPECT_EQ(inputErrorText([] { reader("a: \"one\\ntwo\"").text("a"); }),
            "room.yaml: a: must be a text on one line");
  EXPECT_EQ(inputErrorText([] { reader("a: perhaps").flag("a", true); }),
            "room.yaml: a: must be true or false");
  EXPECT_EQ(inputErrorText([] { reader("{}").child("a"); }),
            "room.yaml: a: is missing; must be a map");
  EXPECT_EQ(inputErrorText([] { reader("a: 1").child("a"); }),
            "room.yaml: a: must be a map (key: value)");
  EXPECT_EQ(inputErrorText([] { reader("a: 1").children("a"); }),
            "room.yaml: a: must be a list of maps");
  EXPECT_EQ(inputErrorText([] { reader("a: [{b: 1}, 2]").children("a"); }),
            "room.yaml: a[1]: must be a map (key: value)");
}

TEST(YamlReader, namesThePathToNestedKeys) {
  YamlReader yaml = reader("boxes: [{size: {x: 1}}, {size: {x: -1}}]");
  std::vector<YamlReader> boxes = yaml.children("boxes");
  EXPECT_EQ(inputErrorText([&] { boxes.at(1).child("size").number("x", 0, 9); }),
            "room.yaml: boxes[1].size.x: is -1; must be a number in [0, 9]");
}

TEST(YamlReader, refusesUnknownAndRepeatedKeys) {
  YamlReader yaml = reader("mu: 1\nnu: 2\nxi: 3\n");
  yaml.number("mu", 0, 2);
  EXPECT_EQ(inputErrorText([&] { yaml.finish(); }), "room.yaml: unknown key(s): nu, xi");
  YamlReader twice = reader("mu: 1\nmu: 2\n");
  twice.number("mu", 0, 2);
  EXPECT_EQ(inputErrorText([&] { twice.finish(); }), "room.yaml: mu: is given twice");
  EXPECT_EQ(inputErrorText([] { reader("\"a\\nb\": 1").finish(); }),
            "room.yaml: unknown key(s): a b");
  EXPECT_NE(inputErrorText([] { reader("? [1, 2]\n: 3\n").finish(); }), "");
}

TEST(YamlReader, refusesFilesThatAreNoMaps) {
  const TemporaryFolder folder;
  const std::string missing = (folder.path() / "missing.yaml").string();
  EXPECT_EQ(inputErrorText([&] { YamlReader::fromFile(missing); }),
            missing + ": cannot be read; is the path right?");
  const std::string cut = folder.write("cut.yaml", "boxes: [{name: wall, size").string();
  EXPECT_EQ(inputErrorText([&] { YamlReader::fromFile(cut); }).find(cut + ": is not valid YAML: "),
            0U);
  for (const char* text : {"", "[1, 2]", "word"}) {
    const std::string file = folder.write("list.yaml", text).string();
    EXPECT_EQ(inputErrorText([&] { YamlReader::fromFile(file); }),
              file + ": must hold a YAML map (key: value)");
  }
  EXPECT_EQ(inputErrorText([&] { YamlReader::fromFile(folder.path()); }),
            folder.path().string() + ": cannot be read; is it a file?");
}

TEST(YamlReader, refusesAFifoWithoutWaiting) {
  const TemporaryFolder folder;
  const std::string fifo = (folder.path() / "fifo.yaml").string();
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(inputErrorText([&] { YamlReader::fromFile(fifo); }),
            fifo + ": cannot be read; is it a file?");
}

/// Writes 0.5 as "0,5", as the locales of half of Europe do.
class CommaDecimals : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
};

TEST(YamlReader, doesNotFollowTheLocale) {
  const std::locale before = std::locale::global(
      std::locale(std::locale::classic(), new CommaDecimals));  // the locale takes ownership
  EXPECT_EQ(reader("mu: 0.5").number("mu", 0, 2), 0.5);
  std::locale::global(before);
}

}  // namespace
}  // namespace casepush
