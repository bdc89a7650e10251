// Counts what the calling thread allocates, for tests of code that must not.
#pragma once

long AllocationsOfThisThread();
