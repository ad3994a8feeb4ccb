// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's target: bytes as a file, as they are and with the checksums that they should
// have. Only cartan::Error may come of it.
#include "CompressedFiles.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  compressed::Bytes file(data, data + size);
  compressed::ProblemOf(file);
  compressed::Reseal(file);
  compressed::ProblemOf(file);
  return 0;
}
