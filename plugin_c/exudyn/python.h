// What is called of Python: few functions of its stable interface, handed over when the library is
// loaded, so that one library serves every Python, and building it needs no header of Python.

#ifndef INERTER_EXUDYN_PYTHON_H_
#define INERTER_EXUDYN_PYTHON_H_

#include <stddef.h>

typedef struct Object_ Object;  // a PyObject

// a Py_buffer: what an array lends of its memory
typedef struct Buffer_ {
  void* data;
  Object* owner;
  ptrdiff_t length;  // bytes
  ptrdiff_t item;
  int read_only;
  int dimensions;
  char* format;
  ptrdiff_t* shape;
  ptrdiff_t* strides;
  ptrdiff_t* offsets;
  void* internal;
} Buffer;

enum { INERTER_BUFFER_SIMPLE = 0 };  // PyBUF_SIMPLE: numbers that follow each other

// name, type of the answer, arguments: the order is that of the table handed over
#define INERTER_PYTHON(X)                                         \
  X(PyTuple_GetItem, Object*, (Object*, ptrdiff_t))               \
  X(PyLong_AsVoidPtr, void*, (Object*))                           \
  X(PyList_Size, ptrdiff_t, (Object*))                            \
  X(PyList_GetItem, Object*, (Object*, ptrdiff_t))                \
  X(PyList_New, Object*, (ptrdiff_t))                             \
  X(PyList_SetItem, int, (Object*, ptrdiff_t, Object*))           \
  X(PyFloat_FromDouble, Object*, (double))                        \
  X(PyFloat_AsDouble, double, (Object*))                          \
  X(PyErr_Occurred, Object*, (void))                              \
  X(PyErr_SetString, void, (Object*, const char*))                \
  X(PyObject_CallObject, Object*, (Object*, Object*))             \
  X(PyObject_GetAttr, Object*, (Object*, Object*))                \
  X(PyObject_CallMethodObjArgs, Object*, (Object*, Object*, ...)) \
  X(PyObject_GetBuffer, int, (Object*, Buffer*, int))             \
  X(PyBuffer_Release, void, (Buffer*))                            \
  X(Py_IncRef, void, (Object*))                                   \
  X(Py_DecRef, void, (Object*))

typedef struct Python_ {
// NOLINTNEXTLINE(bugprone-macro-parentheses): types
#define X(name, answer, arguments) answer(*name) arguments;
  INERTER_PYTHON(X)
#undef X
} Python;

extern Python inerter_python;  // handed over by inerter_exudyn_begin

// a PyMethodDef
typedef struct Method_ {
  const char* name;
  Object* (*call)(Object* self, Object* arguments);
  int flags;
  const char* description;
} Method;

extern Method inerter_sensor_method;

enum { INERTER_METHOD_ARGUMENTS = 0x0001 };  // METH_VARARGS

#endif  // INERTER_EXUDYN_PYTHON_H_
