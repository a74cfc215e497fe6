// Whatever happens to a file, loading it either works or gives an InputError of one line.

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/model/catalog.h"
#include "common/temporary_folder.h"

namespace casepush {
namespace {

constexpr int kTrials = 300;

std::string readText(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Cuts the text off, overwrites a character, or removes or repeats a stretch of it.
std::string damaged(std::string text, Random* random) {
  constexpr char kCharacters[] = "0123456789-.,:;<>[]{}\"'/\\ \n\tenaif\0&#*|";
  const std::size_t begin = random->below(text.size());
  const std::size_t length = 1 + random->below(60);
  switch (random->below(4)) {
    case 0:
      return text.substr(0, begin);
    case 1:
      text[begin] = kCharacters[random->below(sizeof(kCharacters))];
      return text;
    case 2:
      return text.erase(begin, length);
    default:
      return text.insert(begin, text.substr(begin, length));
  }
}

void expectCleanFailures(const std::string& text, const std::function<void(std::string)>& load) {
  Random random(1);
  int refused = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    try {
      load(damaged(text, &random));
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << "trial " << trial << ": " << error.what();
    }
  }
  EXPECT_GT(refused, kTrials / 4);
}

class DamagedFiles : public testing::Test {
 protected:
  const std::filesystem::path config_ = Catalog::standard().share() / "config";
  TemporaryFolder folder_;
};

TEST_F(DamagedFiles, urdf) {
  folder_.write("chair.yaml", readText(config_ / "objects/office_chair.yaml"));
  expectCleanFailures(
      readText(config_ / "objects/office_chair.urdf"),
      [&](const std::string& text) { loadObjectModel(folder_.write("chair.urdf", text)); });
}

TEST_F(DamagedFiles, objectYaml) {
  const auto urdf = folder_.write("chair.urdf", readText(config_ / "objects/office_chair.urdf"));
  expectCleanFailures(readText(config_ / "objects/office_chair.yaml"),
                      [&](const std::string& text) {
                        folder_.write("chair.yaml", text);
                        loadObjectModel(urdf);
                      });
}

TEST_F(DamagedFiles, robotYaml) {
  const auto urdf = folder_.write("robot.urdf", readText(config_ / "robots/cobot.urdf"));
  expectCleanFailures(readText(config_ / "robots/cobot.yaml"), [&](const std::string& text) {
    folder_.write("robot.yaml", text);
    loadRobotModel(urdf);
  });
}

TEST_F(DamagedFiles, worldYaml) {
  expectCleanFailures(readText(config_ / "worlds/office.yaml"), [&](const std::string& text) {
    loadWorldModel(folder_.write("world.yaml", text));
  });
}

}  // namespace
}  // namespace casepush
