// See heap_stack.h.

#include "heap_stack.h"

#include <stdlib.h>
#include <string.h>

// blocks of this thread, newest first; a mark is a block too
typedef struct Block_ {
  struct Block_* next;
  int mark;
  _Alignas(16) unsigned char bytes[];
} Block;

static _Thread_local Block* newest;

static Block* push(size_t size, int mark) {
  Block* block = malloc(sizeof(Block) + size);
  if (!block) {
    abort();
  }
  *block = (Block){newest, mark};
  newest = block;
  return block;
}

void* heap_block(size_t size) {
  Block* block = push(size, 0);

  // what is read before it is written is a NaN, or an index far away
  memset(block->bytes, 0xff, size);
  return block->bytes;
}

void heap_mark(mjData* d) {
  (void)d;
  push(0, 1);
}

void heap_free(mjData* d) {
  (void)d;
  for (int mark = 0; !mark;) {
    Block* block = newest;
    if (!block) {
      abort();  // freed more often than marked
    }
    newest = block->next;
    mark = block->mark;
    free(block);
  }
}
