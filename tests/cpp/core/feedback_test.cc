#include "takt/core/feedback.h"

#include <gtest/gtest.h>

#include <array>

namespace takt {
namespace {

TEST(Feedback, DoneAbortedAndErrorAreFinal) {
  EXPECT_FALSE(IsFinal(FeedbackState::kBusy));
  EXPECT_FALSE(IsFinal(FeedbackState::kActive));
  EXPECT_TRUE(IsFinal(FeedbackState::kDone));
  EXPECT_TRUE(IsFinal(FeedbackState::kAborted));
  EXPECT_TRUE(IsFinal(FeedbackState::kError));
}

TEST(FeedbackSink, KeepsTheOrderAndIgnoresTicketZero) {
  std::array<FeedbackEvent, 4> storage;
  FeedbackSink sink(storage);
  sink.Report({.ticket = 3, .cycle = 7, .state = FeedbackState::kActive});
  sink.Report({.ticket = 0, .cycle = 7, .state = FeedbackState::kDone});
  sink.Report({.ticket = 2, .cycle = 7, .state = FeedbackState::kError, .error = ErrorId::kState});
  ASSERT_EQ(sink.events().size(), 2u);
  EXPECT_EQ(sink.events()[0].ticket, 3u);
  EXPECT_EQ(sink.events()[1].error, ErrorId::kState);
  EXPECT_EQ(sink.lost(), 0u);
  sink.Clear();
  EXPECT_TRUE(sink.events().empty());
}

TEST(FeedbackSink, CountsWhatDoesNotFitAndWritesNothing) {
  std::array<FeedbackEvent, 3> storage;
  FeedbackSink sink(std::span<FeedbackEvent>(storage.data(), 2));
  for (Ticket t = 1; t <= 5; ++t) sink.Report({.ticket = t});
  EXPECT_EQ(sink.events().size(), 2u);
  EXPECT_EQ(sink.lost(), 3u);
  EXPECT_EQ(storage[2].ticket, 0u);
  sink.Clear();
  EXPECT_EQ(sink.lost(), 3u);
}

}  // namespace
}  // namespace takt
