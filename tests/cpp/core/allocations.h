// Counts the allocations of the calling thread, for tests of code that must not allocate: calls of malloc, which new
// also makes, and Eigen without new.
#pragma once

long AllocationsOfThisThread();
