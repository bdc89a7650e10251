#include "allocations.h"

#include <gtest/gtest.h>

#include <new>

// The helper of other tests: it must detect allocations.
TEST(Allocations, AreSeen) {
  const long before = AllocationsOfThisThread();
  ::operator delete(::operator new(64));
  EXPECT_EQ(AllocationsOfThisThread(), before + 1);
}
