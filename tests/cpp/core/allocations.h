// Counts what the calling thread allocates, for tests of code that must not: calls of malloc, which new makes too and
// Eigen makes without it.
#pragma once

long AllocationsOfThisThread();
