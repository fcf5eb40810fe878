// The scratch memory of mjData as blocks of the heap, one for each request: a
// sanitizer then sees a look beyond the end of one, which inside the engine's
// own stack would be another's memory. Included before every file of the
// plugin, by -include.

#ifndef TESTS_SANITIZED_HEAP_STACK_H_
#define TESTS_SANITIZED_HEAP_STACK_H_

#include <mujoco/mujoco.h>

void heap_mark(mjData* d);
void heap_free(mjData* d);
void* heap_block(size_t size);

#define mj_markStack(d) heap_mark(d)
#define mj_freeStack(d) heap_free(d)
#define mj_stackAllocNum(d, n) ((mjtNum*)heap_block(sizeof(mjtNum) * (size_t)(n)))
#define mj_stackAllocInt(d, n) ((int*)heap_block(sizeof(int) * (size_t)(n)))
#define mj_stackAllocByte(d, n, alignment) heap_block((size_t)(n))

#endif  // TESTS_SANITIZED_HEAP_STACK_H_
