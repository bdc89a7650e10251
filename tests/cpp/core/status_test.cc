#include "takt/core/status.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace takt {
namespace {

TEST(Status, EveryErrorHasANameAndASentence) {
  std::set<std::string_view> names, texts;
  for (const auto& [id, name, text] : Errors()) {
    EXPECT_FALSE(ErrorText(id).empty());
    EXPECT_FALSE(ErrorText(id).ends_with('.')) << ErrorText(id);
    EXPECT_NE(ErrorText(id), "unknown error") << static_cast<int>(id);
    EXPECT_TRUE(names.insert(ErrorName(id)).second) << ErrorName(id);
    EXPECT_TRUE(texts.insert(ErrorText(id)).second) << ErrorText(id);
  }
}

TEST(Status, TheListHasEveryNumberThatHasAName) {
  std::set<int> listed, named;
  for (const ErrorInfo& error : Errors()) listed.insert(static_cast<int>(error.id));
  for (int number = 0; number <= 0xFFFF; ++number) {
    if (ErrorName(static_cast<ErrorId>(number)) != "unknown") named.insert(number);
  }
  EXPECT_EQ(listed, named);
}

TEST(Status, KeepsTheSeedsNumbersAndNames) {
  const auto name = [](int number) { return std::string(ErrorName(static_cast<ErrorId>(number))); };
  EXPECT_EQ(name(1), "ETime");
  EXPECT_EQ(name(2), "EDistance");
  EXPECT_EQ(name(3), "EDev");
  EXPECT_EQ(name(4), "EBlanding");
  EXPECT_EQ(name(5), "EParam");
  EXPECT_EQ(name(6), "EAxStop");
  EXPECT_EQ(name(7), "EAxis");
  EXPECT_EQ(name(8), "Ecil");
  EXPECT_EQ(name(9), "Ehome");
  EXPECT_EQ(name(10), "Epower");
  EXPECT_EQ(name(11), "Eerrstop");
  EXPECT_EQ(name(12), "Econst");
  EXPECT_EQ(name(13), "EpowerOff");
  EXPECT_EQ(name(2001), "ERRPOS");
  EXPECT_EQ(name(2004), "ERRLIP");
  EXPECT_EQ(name(2005), "ERRLIN");
  EXPECT_EQ(name(2006), "ERRSWP");
  EXPECT_EQ(name(2007), "ERRSWN");
  EXPECT_EQ(name(8001), "ERRPOSG");
}

TEST(Status, UnknownNumbersSaySo) {
  EXPECT_EQ(ErrorText(static_cast<ErrorId>(4711)), "unknown error");
  EXPECT_EQ(ErrorName(static_cast<ErrorId>(4711)), "unknown");
}

TEST(Status, OkLimitedAndFailedAreThreeThings) {
  EXPECT_TRUE(Status::Ok().ok());
  EXPECT_TRUE(Status::Limited(LimitedBy::kJerk).ok());
  EXPECT_NE(Status::Limited(LimitedBy::kJerk), Status::Ok());
  EXPECT_TRUE(Status::Failed(ErrorId::kPlanning).failed());
}

}  // namespace
}  // namespace takt
