// Push constants of the prefix sum.
#ifndef UMBRAGE_GPU_SCAN_SHARED_H
#define UMBRAGE_GPU_SCAN_SHARED_H
#include "core/shared_math.h"

UMB_NAMESPACE_BEGIN

UMB_CONST uint ScanThreads = 128u;
UMB_CONST uint ScanItemsPerThread = 16u;
UMB_CONST uint ScanBlock = 2048u;

struct ScanPush {
  uint64_t values;   // counts, turned into exclusive prefix sums
  uint64_t sums;     // one a block
  uint64_t total;    // where the sum of everything goes
  uint64_t counted;  // 0, or the address of a word: only the first word × scale values count
  uint scale;
  uint count;        // at most
};
UMB_ASSERT_SIZE(ScanPush, 40);

UMB_NAMESPACE_END
#endif
