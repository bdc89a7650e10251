#include "takt/kinematics/xml_shape.h"

#include <gtest/gtest.h>

#include <string>

namespace takt::kinematics {
namespace {

std::string Times(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

// EN-37
TEST(XmlCheck, TakesWhatIsWellFormed) {
  for (const char* text :
       {"<a/>", "<a></a>",
        "<?xml version='1.0'?>\n<!-- <b> -->\n<!DOCTYPE a>\n<a x=\"1\" y = '>' ><b.c-d:e/>text</a >\n",
        "<a><![CDATA[<b>]]></a>", "\xEF\xBB\xBF<a/>", "<a><b></b><b/></a>", "<ä x='/>'/>"}) {
    EXPECT_EQ(ShapeOf(text, 2), XmlCheck::kGood) << text;
  }
}

// EN-37
TEST(XmlCheck, RefusesWhatIsNot) {
  for (const char* text :
       {"", "text", "<a>", "</a>", "<a></b>", "<a", "<a x></a>", "<a x=1/>", "<a x='1/>", "<a x='<'/>", "<1/>", "<a/",
        "<a><!-- </a>", "<!DOCTYPE a [<!ENTITY b 'c'>]><a/>", "<a / >", "< a/>"}) {
    EXPECT_EQ(ShapeOf(text, 2), XmlCheck::kMalformed) << text;
  }
  EXPECT_EQ(ShapeOf(std::string("<a/>\0", 5), 2), XmlCheck::kMalformed);
}

// EN-37: levels, not elements.
TEST(XmlCheck, CountsLevels) {
  EXPECT_EQ(ShapeOf(Times("<a>", 100) + Times("</a>", 100), 100), XmlCheck::kGood);
  EXPECT_EQ(ShapeOf(Times("<a>", 101) + Times("</a>", 101), 100), XmlCheck::kTooDeep);
  EXPECT_EQ(ShapeOf(Times("<a>", 1'000'000), 100), XmlCheck::kTooDeep);
  EXPECT_EQ(ShapeOf("<a>" + Times("<b x='/>'></b><c/>", 10'000) + "</a>", 2), XmlCheck::kGood);
}

}  // namespace
}  // namespace takt::kinematics
