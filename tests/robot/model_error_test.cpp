// SPDX-License-Identifier: BSD-3-Clause
#include <sys/stat.h>

#include "robots.hpp"

namespace tactus::robot {
namespace {

using support::Error;
using support::Status;
using testing::load_text;
using testing::TempFolder;

/// Two links and what stands between them.
std::string two_links(const std::string& rest) {
  return "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\n" + rest + "</robot>";
}

std::string joint(const std::string& inside, const std::string& type = "revolute") {
  return two_links("<joint name=\"j\" type=\"" + type + "\"><parent link=\"a\"/><child link=\"b\"/>" + inside +
                   "</joint>");
}

std::string shape(const std::string& text) {
  return "<robot name=\"r\">\n<link name=\"a\">\n<collision><geometry>" + text +
         "</geometry></collision></link></robot>";
}

constexpr const char* limit = "<limit lower='-1' upper='1' velocity='1' effort='1'/>";

struct Case {
  const char* name;
  std::string urdf;
  std::vector<std::string> expected;  ///< parts of the error's text
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

std::vector<Case> xml_cases() {
  std::string deep, wide = "<robot name='r'><link name='a'", many;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  for (int i = 0; i < 65; ++i) wide += " a" + std::to_string(i) + "='1'";
  for (int i = 0; i < 200'001; ++i) many += "<a/>";
  return {
      {"Empty", "", {"XML: found"}},
      {"NotXml", "hello", {"XML: found"}},
      {"Unclosed", "<robot name='r'>\n<link name='a'>\n</robot>", {":3: XML"}},
      {"WrongRoot", "<sdf/>", {"found <sdf>, expected <robot>"}},
      {"Deep", deep, {"nested deeper than 64"}},
      {"DeepInOneQuote", "<robot a=\"<\">" + deep, {"nested deeper than 64"}},
      {"DeepAfterClosing", "</a></a></a><robot>" + deep, {"an end tag without its start"}},
      {"DeepInComment", "<!-- " + deep + " -->", {"XML: found"}},
      {"ManyAttributes", wide + "/></robot>", {"more than 64 attributes"}},
      {"ManyElements", "<robot name='r'>" + many + "</robot>", {"more than 200000 elements"}},
      {"Huge", "<robot name='r'>" + std::string((8u << 20) + 1, ' ') + "</robot>", {"more than 8388608 bytes"}},
      {"ZeroByte", std::string("<robot name='r'>\0</robot>", 25), {"a zero byte"}},
  };
}

std::vector<Case> tree_cases() {
  return {
      {"NoLinks", "<robot name='r'/>", {"no link without a parent"}},
      {"UnnamedRobot", "<robot><link name='a'/></robot>", {"robot: found no name"}},
      {"UnnamedLink", "<robot name='r'>\n<link/></robot>", {":2: link: found no name"}},
      {"UnnamedJoint",
       two_links("<joint type='fixed'><parent link='a'/><child link='b'/></joint>"),
       {":2: joint: found no name"}},
      {"TwoLinksOfOneName",
       "<robot name='r'><link name='a'/>\n<link name='a'/></robot>",
       {":2: link a: found a second link"}},
      {"TwoJointsOfOneName",
       "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><joint name='j' type='fixed'><parent "
       "link='a'/><child link='b'/></joint>"
       "<joint name='j' type='fixed'><parent link='a'/><child link='c'/></joint></robot>",
       {"joint j: found a second joint"}},
      {"TwoRoots", two_links(""), {"2 links without a parent (a, b)"}},
      {"TwoParents",
       "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><joint name='j' type='fixed'><parent "
       "link='a'/><child link='b'/></joint>"
       "<joint name='k' type='fixed'><parent link='a'/><child link='c'/></joint>"
       "<joint name='l' type='fixed'><parent link='c'/><child link='b'/></joint></robot>",
       {"joint l: found a second parent of link b (the first: joint j)"}},
      {"Cycle",
       "<robot name='r'><link name='root'/><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent "
       "link='a'/><child link='b'/></joint>"
       "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>",
       {"below itself"}},
      {"SelfLoop",
       two_links("<joint name='j' type='fixed'><parent link='b'/><child link='b'/></joint>"),
       {"link b below itself"}},
      {"MissingLink",
       two_links("<joint name='j' type='fixed'><parent link='a'/><child link='c'/></joint>"),
       {"joint j: found child link c that is missing"}},
      {"NoParent",
       two_links("<joint name='j' type='fixed'><child link='b'/></joint>"),
       {"joint j: found no parent link"}},
      {"MissingLeader",
       joint(std::string(limit) + "<mimic joint='ghost'/>"),
       {"joint j: found a mimic of joint ghost that is missing"}},
      {"OwnLeader", joint(std::string(limit) + "<mimic joint='j'/>"), {"that is a mimic itself"}},
      {"NamelessLeader", joint(std::string(limit) + "<mimic/>"), {"a mimic without a joint"}},
      {"MimicChain",
       "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>"
       "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
       "<joint name='k' type='continuous'><parent link='b'/><child link='c'/><mimic joint='j'/></joint>"
       "<joint name='l' type='continuous'><parent link='c'/><child link='d'/><mimic joint='k'/></joint></robot>",
       {"joint l: found a mimic of joint k that is a mimic itself"}},
  };
}

std::vector<Case> joint_cases() {
  return {
      {"NoLimits", joint(""), {"joint j: found no velocity limit, expected a velocity > 0"}},
      {"NoVelocity",
       joint("<limit lower='-1' upper='1' effort='1'/>"),
       {"joint j: found no velocity limit, expected a velocity > 0"}},
      {"ZeroVelocity",
       joint("<limit lower='-1' upper='1' effort='1' velocity='0'/>"),
       {"joint j: found velocity 0, expected a velocity > 0"}},
      {"ZeroVelocityOfAWheel", joint("<limit effort='1' velocity='0'/>", "continuous"), {"joint j: found velocity 0"}},
      {"LowerAboveUpper", joint("<limit lower='2' upper='1' effort='1' velocity='1'/>"), {"lower 2 > upper 1"}},
      {"NanLimit",
       joint("<limit lower='nan' upper='1' effort='1' velocity='1'/>"),
       {"lower=\"nan\", expected a finite number"}},
      {"InfiniteLimit", joint("<limit lower='-1' upper='inf' effort='1' velocity='1'/>"), {"upper=\"inf\""}},
      {"ZeroAxis", joint(std::string("<axis xyz='0 0 0'/>") + limit), {"axis \"0 0 0\""}},
      {"AxisOfTwo", joint(std::string("<axis xyz='0 1'/>") + limit), {"axis \"0 1\""}},
      {"NanOrigin",
       joint(std::string("<origin xyz='0 nan 0'/>") + limit),
       {"xyz=\"0 nan 0\", expected 3 finite numbers"}},
      {"OriginOfTwo", joint(std::string("<origin rpy='0 1'/>") + limit), {"rpy=\"0 1\""}},
      {"OriginOfFour", joint(std::string("<origin xyz='0 1 2 3'/>") + limit), {"xyz=\"0 1 2 3\""}},
      {"Floating",
       joint("", "floating"),
       {"joint j: found type floating, expected fixed, revolute, continuous or prismatic"}},
      {"Planar", joint(limit, "planar"), {"found type planar"}},
      {"NoType", two_links("<joint name='j'><parent link='a'/><child link='b'/></joint>"), {"joint j: found no type"}},
      {"BadMultiplier", joint(std::string(limit) + "<mimic joint='j' multiplier='x'/>"), {"multiplier=\"x\""}},
  };
}

std::vector<Case> shape_cases() {
  return {
      {"Capsule",
       shape("<capsule radius='1' length='1'/>"),
       {":3: link a: found shape capsule, expected box, cylinder, sphere or mesh"}},
      {"BoxOfTwo", shape("<box size='1 1'/>"), {"link a: found size=\"1 1\", expected 3 numbers > 0"}},
      {"NegativeBox", shape("<box size='1 -1 1'/>"), {"size=\"1 -1 1\""}},
      {"NanSphere", shape("<sphere radius='nan'/>"), {"radius=\"nan\""}},
      {"HugeNumber", shape("<sphere radius='1e999'/>"), {"radius=\"1e999\""}},
      {"NegativeCylinder", shape("<cylinder radius='1' length='-2'/>"), {"length=\"-2\""}},
      {"NoLength", shape("<cylinder radius='1'/>"), {"length=\"\""}},
      {"NoShape", shape(""), {"link a: found no shape"}},
      {"TwoShapes", shape("<sphere radius='1'/><sphere radius='2'/>"), {"more than one shape"}},
      {"NoGeometry", "<robot name='r'><link name='a'><collision/></link></robot>", {"link a: found no shape"}},
      {"NoFilename", shape("<mesh/>"), {"a mesh without a filename"}},
      {"FlatScale", shape("<mesh filename='x.stl' scale='1 0 1'/>"), {"scale=\"1 0 1\"", "no file"}},
      {"EverythingAtOnce",
       "<robot name='r'>\n<link name='a'><collision><geometry><box size='1'/></geometry></collision></link>\n"
       "<link name='b'><collision><geometry><capsule/></geometry></collision></link>\n"
       "<joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint></robot>",
       {": 3 problems", ":2: link a", ":3: link b", ":4: joint j"}},
  };
}

class RefusedModel : public ::testing::TestWithParam<Case> {};

TEST_P(RefusedModel, NamesWhatIsWrong) {
  try {
    load_text(GetParam().urdf);
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::bad_robot);
    for (const std::string& part : GetParam().expected)
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Xml, RefusedModel, ::testing::ValuesIn(xml_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Tree, RefusedModel, ::testing::ValuesIn(tree_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Joint, RefusedModel, ::testing::ValuesIn(joint_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Shape, RefusedModel, ::testing::ValuesIn(shape_cases()), name_of);

Status status_of(const ModelSource& source) {
  try {
    load_model(source);
  } catch (const Error& error) {
    return error.status();
  }
  return Status::ok;
}

TEST(RefusedFile, MissingFifoAndFolder) {
  const TempFolder folder;
  const auto fifo = folder.path() / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(status_of({folder.path() / "none.urdf", {}, {}}), Status::file_not_found);
  EXPECT_EQ(status_of({fifo, {}, {}}), Status::file_unreadable);
  EXPECT_EQ(status_of({folder.path(), {}, {}}), Status::file_unreadable);
}

TEST(RefusedSrdf, UnknownLinksAreNamed) {
  const TempFolder folder;
  const auto urdf = folder.write("robot.urdf", "<robot name='r'><link name='a'/></robot>");
  const auto srdf =
      folder.write("robot.srdf", "<robot name='r'>\n<disable_collisions link1='a' link2='ghost'/></robot>");
  try {
    load_model({urdf, {}, srdf});
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::bad_robot);
    EXPECT_NE(std::string(error.what()).find("robot.srdf:2: disable_collisions: found link ghost"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace tactus::robot
