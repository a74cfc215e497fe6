#include "casepush/model/catalog.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "common/input_error_text.h"
#include "common/temporary_folder.h"
#include "model/small_models.h"

namespace casepush {
namespace {

class CatalogTest : public testing::Test {
 protected:
  CatalogTest() {
    folder_.write("config/objects/cart.urdf", smallCartUrdf());
    folder_.write("config/objects/cart.yaml", smallCartYaml());
    folder_.write("config/objects/box.urdf", "");
    folder_.write("config/robots/bot.urdf", smallRobotUrdf());
    folder_.write("config/robots/bot.yaml", smallRobotYaml());
    folder_.write("config/worlds/room.yaml", smallWorldYaml());
  }

  TemporaryFolder folder_;
};

TEST_F(CatalogTest, listsNamesInOrder) {
  const Catalog catalog(folder_.path());
  EXPECT_EQ(catalog.objectNames(), (std::vector<std::string>{"box", "cart"}));
  EXPECT_EQ(catalog.robotNames(), std::vector<std::string>{"bot"});
  EXPECT_EQ(catalog.worldNames(), std::vector<std::string>{"room"});
}

TEST_F(CatalogTest, findsByNameAndByFile) {
  const Catalog catalog(folder_.path());
  EXPECT_EQ(catalog.object("cart").name, "cart");
  EXPECT_EQ(catalog.robot("bot").name, "bot");
  EXPECT_EQ(catalog.world("room").name, "room");
  const std::string file = folder_.write("elsewhere/other.urdf", smallCartUrdf()).string();
  folder_.write("elsewhere/other.yaml", smallCartYaml());
  EXPECT_EQ(catalog.object(file).name, "other");
}

TEST_F(CatalogTest, loadsEveryKindOfObjectInAWorldOnceByItsOwnName) {
  const std::string file = folder_.write("elsewhere/other.urdf", smallCartUrdf()).string();
  folder_.write("elsewhere/other.yaml", smallCartYaml());
  WorldModel world;
  for (const std::string& model : {std::string("cart"), file, std::string("cart")}) {
    world.objects.emplace_back();
    world.objects.back().model = model;
  }
  const std::map<std::string, ObjectModel> models = Catalog(folder_.path()).objectsIn(world);
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models.at("cart").name, "cart");
  EXPECT_EQ(models.at("other").name, "other");
}

TEST_F(CatalogTest, saysWhatThereIsWhenANameIsUnknown) {
  const Catalog catalog(folder_.path());
  EXPECT_EQ(
      inputErrorText([&] { catalog.object("chair"); }),
      "config/objects: there is none named 'chair'; known are: box, cart; or give a .urdf file");
  EXPECT_EQ(inputErrorText([&] { catalog.world(""); }),
            "config/worlds: there is none named ''; known are: room; or give a .yaml file");
  EXPECT_EQ(inputErrorText([&] { catalog.world("no/such.yaml"); }),
            "no/such.yaml: cannot be read; is the path right?");
}

TEST_F(CatalogTest, refusesAFolderWithoutConfig) {
  const TemporaryFolder empty;
  EXPECT_EQ(inputErrorText([&] { Catalog catalog(empty.path()); }),
            empty.path().string() +
                ": has no folder config/; set CASEPUSH_SHARE to casepush's share folder");
}

TEST_F(CatalogTest, standardFollowsTheEnvironmentAndFallsBackToThePackage) {
  const std::string before = getenv("CASEPUSH_SHARE") != nullptr ? getenv("CASEPUSH_SHARE") : "";
  ASSERT_EQ(setenv("CASEPUSH_SHARE", folder_.path().c_str(), 1), 0);
  EXPECT_EQ(Catalog::standard().share(), folder_.path());
  ASSERT_EQ(unsetenv("CASEPUSH_SHARE"), 0);
  EXPECT_TRUE(std::filesystem::is_directory(Catalog::standard().share() / "config/objects"));
  ASSERT_EQ(setenv("CASEPUSH_SHARE", before.c_str(), 1), 0);
}

TEST(PlaceObject, findsInstancesAndKindsAndReplacesTheFirstOtherwise) {
  const Catalog catalog = Catalog::standard();
  WorldModel world = catalog.world("office");
  const std::string first = world.objects.front().id;
  EXPECT_EQ(placeObject(world, catalog, ""), first);
  EXPECT_EQ(placeObject(world, catalog, first), first);
  EXPECT_EQ(placeObject(world, catalog, "office_chair"), first);
  TemporaryFolder folder;
  const auto objects = catalog.share() / "config" / "objects";
  for (const char* extension : {".urdf", ".yaml"}) {
    std::filesystem::copy_file(objects / (std::string("office_chair") + extension),
                               folder.path() / (std::string("stool") + extension));
  }
  const std::string stool = (folder.path() / "stool.urdf").string();
  EXPECT_EQ(placeObject(world, catalog, stool), "stool_1");
  EXPECT_EQ(world.objects.front().model, stool);
  EXPECT_EQ(placeObject(world, catalog, stool), "stool_1");
}

TEST(PlaceObject, refusesWorldsWithoutObjectsAndUnknownObjects) {
  const Catalog catalog = Catalog::standard();
  WorldModel world = catalog.world("office");
  EXPECT_THROW(placeObject(world, catalog, "harp"), InputError);
  world.objects.clear();
  EXPECT_THROW(placeObject(world, catalog, "office_chair"), InputError);
}

}  // namespace
}  // namespace casepush
