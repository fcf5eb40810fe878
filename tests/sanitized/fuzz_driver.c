// Inputs for a fuzz target where the compiler brings no fuzzer: random bytes,
// and random changes of what came before.
//
//   fuzz_driver COUNT [SEED]

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "random.h"

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

int main(int argc, char** argv) {
  enum { LONGEST = 512, KEPT = 64 };
  static uint8_t kept[KEPT][LONGEST];
  static size_t sizes[KEPT];
  long count = argc > 1 ? atol(argv[1]) : 10000;
  Random random = {argc > 2 ? strtoull(argv[2], NULL, 10) : 20261122};

  // texts with which changes begin
  const char* const seeds[] = {
      "inertance 113\nfriction lugre\ncoulomb_force 10\nstatic_force 14",
      "inertance 2\nseries_stiffness 1e5\nseries_damping 3\nbacklash 1e-3",
      "friction bouc_wen\nbw_stiffness 1e4\nbw_exponent 2.5",
      "gas_pressure 1e5\ngas_area 1e-3\ngas_volume 1e-4\ngas_law expanded"};
  for (int i = 0; i < KEPT; i++) {
    sizes[i] = strlen(seeds[i % 4]);
    memcpy(kept[i], seeds[i % 4], sizes[i]);
  }
  for (long i = 0; i < count; i++) {
    uint8_t* input = kept[below(&random, KEPT)];
    size_t* size = sizes + (input - kept[0]) / LONGEST;
    if (below(&random, 4) == 0) {
      *size = (size_t)below(&random, LONGEST);
      for (size_t k = 0; k < *size; k++) input[k] = (uint8_t)below(&random, 256);
    } else {
      for (int changes = 1 + below(&random, 8); changes && *size; changes--) {
        input[below(&random, (int)*size)] = (uint8_t)below(&random, 256);
      }
      if (*size < LONGEST && below(&random, 2)) input[(*size)++] = (uint8_t)below(&random, 256);
    }

    // exactly as long as it is, so that a look beyond it is reported
    uint8_t* exact = malloc(*size + 1);
    if (!exact) {
      abort();
    }
    memcpy(exact, input, *size);
    LLVMFuzzerTestOneInput(exact, *size);
    free(exact);
  }
  printf("%ld inputs\n", count);
  return 0;
}
