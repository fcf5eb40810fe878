// What is called of Python: few functions of its stable interface, handed over when the library is
// loaded, so that one library serves every Python, and building it needs no header of Python.

#ifndef INERTER_EXUDYN_PYTHON_H_
#define INERTER_EXUDYN_PYTHON_H_

#include <stddef.h>

typedef struct Object_ Object;  // a PyObject

// name, type of the answer, arguments: the order is that of the table handed over
#define INERTER_PYTHON(X)                               \
  X(PyTuple_GetItem, Object*, (Object*, ptrdiff_t))     \
  X(PyLong_AsVoidPtr, void*, (Object*))                 \
  X(PyList_Size, ptrdiff_t, (Object*))                  \
  X(PyList_GetItem, Object*, (Object*, ptrdiff_t))      \
  X(PyList_New, Object*, (ptrdiff_t))                   \
  X(PyList_SetItem, int, (Object*, ptrdiff_t, Object*)) \
  X(PyFloat_FromDouble, Object*, (double))              \
  X(PyFloat_AsDouble, double, (Object*))                \
  X(PyErr_Occurred, Object*, (void))                    \
  X(PyErr_SetString, void, (Object*, const char*))      \
  X(PyObject_CallObject, Object*, (Object*, Object*))   \
  X(Py_IncRef, void, (Object*))                         \
  X(Py_DecRef, void, (Object*))

typedef struct Python_ {
// NOLINTNEXTLINE(bugprone-macro-parentheses): types
#define X(name, answer, arguments) answer(*name) arguments;
  INERTER_PYTHON(X)
#undef X
} Python;

// a PyMethodDef
typedef struct Method_ {
  const char* name;
  Object* (*call)(Object* self, Object* arguments);
  int flags;
  const char* description;
} Method;

enum { INERTER_METHOD_ARGUMENTS = 0x0001 };  // METH_VARARGS

#endif  // INERTER_EXUDYN_PYTHON_H_
