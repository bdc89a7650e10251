// Counts calls of malloc by the calling thread: Eigen does not ask operator new for memory.
#pragma once

long MallocsOfThisThread();
