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
TEST(XmlShape, TakesWhatIsWellFormed) {
  for (const char* text :
       {"<a/>", "<a></a>",
        "<?xml version='1.0'?>\n<!-- <b> -->\n<!DOCTYPE a>\n<a x=\"1\" y = '>' ><b.c-d:e/>text</a >\n",
        "<a><![CDATA[<b>]]></a>", "\xEF\xBB\xBF<a/>", "<a><b></b><b/></a>", "<ä x='/>'/>"}) {
    EXPECT_EQ(ShapeOf(text, 2), XmlShape::kGood) << text;
  }
}

// EN-37
TEST(XmlShape, RefusesWhatIsNot) {
  for (const char* text :
       {"", "text", "<a>", "</a>", "<a></b>", "<a", "<a x></a>", "<a x=1/>", "<a x='1/>", "<a x='<'/>", "<1/>", "<a/",
        "<a><!-- </a>", "<!DOCTYPE a [<!ENTITY b 'c'>]><a/>", "<a / >", "< a/>"}) {
    EXPECT_EQ(ShapeOf(text, 2), XmlShape::kMalformed) << text;
  }
  EXPECT_EQ(ShapeOf(std::string("<a/>\0", 5), 2), XmlShape::kMalformed);
}

// EN-37: levels, not elements.
TEST(XmlShape, CountsLevels) {
  EXPECT_EQ(ShapeOf(Times("<a>", 100) + Times("</a>", 100), 100), XmlShape::kGood);
  EXPECT_EQ(ShapeOf(Times("<a>", 101) + Times("</a>", 101), 100), XmlShape::kTooDeep);
  EXPECT_EQ(ShapeOf(Times("<a>", 1'000'000), 100), XmlShape::kTooDeep);
  EXPECT_EQ(ShapeOf("<a>" + Times("<b x='/>'></b><c/>", 10'000) + "</a>", 2), XmlShape::kGood);
}

}  // namespace
}  // namespace takt::kinematics
