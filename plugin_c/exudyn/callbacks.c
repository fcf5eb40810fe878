// The user functions of an ObjectGenericODE2, evaluated on a tape; what sensors ask is in sensor.c.
//
//   M = B J'J (+ the constant part),   f = forces,   K = -df/dq f_q - df/dq' f_v
//
// Most entries of M are those of others or their negatives, and a number costs Python more than it
// costs the tape: each that differs is made once.
//
// Every function is a built-in function of Python whose self is a tuple; its first item is the
// address of an InerterElement, the others keep alive what that points to.

#include <stddef.h>
#include <stdint.h>

#include "exudyn/python.h"
#include "exudyn/tape.h"

#if defined(_WIN32)
#define INERTER_API __declspec(dllexport)
#else
#define INERTER_API __attribute__((visibility("default")))
#endif

enum { INERTER_LISTED = 9 };  // the most coordinates whose mass matrix is handed over as lists

typedef struct InerterElement_ {
  InerterTape tape;
  int32_t size;             // coordinates of the object
  int32_t nrow;             // of them those of the terminals' nodes
  int32_t ndistinct;        // different entries of B J'J, at most INERTER_LISTED^2 with lists
  int32_t loaded;           // inputs end with the latest accelerations, asked of `reader`
  int32_t known;            // the values on the tape are those of `inputs`
  const int32_t* forces;    // places of the forces, size
  const int32_t* distinct;  // places of the different entries of B J'J, ndistinct
  const int32_t* entries;   // which of them each entry is, nrow x nrow
  int32_t length;           // place of what must not fall below `shortest`, or -1
  double shortest;
  double* mass;        // the mass matrix, size x size; its constant part is in place
  double* jacobian;    // size x size
  Object* mass_array;  // the NumPy arrays of these
  Object* jacobian_array;
  Object* mass_list;      // these as lists, which Exudyn reads faster if they are small,
  Object* jacobian_list;  // or Python's None
  Object* reader;         // (mbs, itemNumber) -> accelerations
  Object* none;           // Python's
  Object* error;          // raised when the terminals meet,
  const char* message;    // with this text
} InerterElement;

Python inerter_python;

static InerterElement* element_of(Object* self) {
  return inerter_python.PyLong_AsVoidPtr(inerter_python.PyTuple_GetItem(self, 0));
}

// copy a list of numbers, at least n; returns whether something differed, -1 if it was no such list
static int copy(Object* list, double* to, int32_t n) {
  if (!list || inerter_python.PyList_Size(list) < n) {
    return -1;
  }
  int changed = 0;
  for (int32_t i = 0; i < n; i++) {
    double value = inerter_python.PyFloat_AsDouble(inerter_python.PyList_GetItem(list, i));
    if (value == -1.0 && inerter_python.PyErr_Occurred()) {
      return -1;
    }
    // NaN differs from itself: the run goes on with it as it would without us
    changed |= !(to[i] == value);
    to[i] = value;
  }
  return changed;
}

// accelerations of the object, as Exudyn knows them at this moment
static int read_accelerations(InerterElement* element, Object* arguments, double* to) {
  Object* found = inerter_python.PyObject_CallObject(element->reader, arguments);
  int changed = found ? copy(found, to, element->size) : -1;
  if (found) {
    inerter_python.Py_DecRef(found);
  }
  return changed;
}

// bring the tape to the arguments (mbs, t, itemNumber, q, q_t, ...); 0, or -1 with an error set
static int update(InerterElement* element, Object* arguments) {
  double* inputs = element->tape.values;
  const int32_t n = element->size;
  int by_place = copy(inerter_python.PyTuple_GetItem(arguments, 3), inputs, n);
  int by_speed = copy(inerter_python.PyTuple_GetItem(arguments, 4), inputs + n, n);
  int by_load = 0;
  if (by_place >= 0 && by_speed >= 0 && element->loaded) {
    by_load = read_accelerations(element, arguments, inputs + 2 * n);
  }
  if (by_place < 0 || by_speed < 0 || by_load < 0) {
    element->known = 0;
    if (!inerter_python.PyErr_Occurred()) {
      inerter_python.PyErr_SetString(element->error,
                                     "coordinates of another number than the element's");
    }
    return -1;
  }
  if (element->known && !by_place && !by_speed && !by_load) {
    return 0;
  }
  inerter_tape_run(&element->tape);
  element->known = 1;
  if (element->length >= 0 && element->tape.values[element->length] < element->shortest) {
    element->known = 0;
    inerter_python.PyErr_SetString(element->error, element->message);
    return -1;
  }
  return 0;
}

static Object* force(Object* self, Object* arguments) {
  InerterElement* element = element_of(self);
  if (!element || update(element, arguments)) {
    return NULL;
  }
  Object* list = inerter_python.PyList_New(element->size);
  for (int32_t i = 0; list && i < element->size; i++) {
    Object* value = inerter_python.PyFloat_FromDouble(element->tape.values[element->forces[i]]);
    inerter_python.PyList_SetItem(list, i, value);
  }
  return list;
}

// put B J'J into the list of lists; 0, or -1 with an error set
static int write_lists(const InerterElement* element) {
  const double* values = element->tape.values;
  Object* made[INERTER_LISTED * INERTER_LISTED];
  for (int32_t i = 0; i < element->ndistinct; i++) {
    made[i] = inerter_python.PyFloat_FromDouble(values[element->distinct[i]]);
    if (!made[i]) {
      while (i-- > 0) inerter_python.Py_DecRef(made[i]);
      return -1;
    }
  }
  const int32_t* entry = element->entries;
  for (int32_t i = 0; i < element->nrow; i++) {
    Object* row = inerter_python.PyList_GetItem(element->mass_list, i);
    for (int32_t k = 0; k < element->nrow; k++) {
      Object* value = made[*entry++];
      inerter_python.Py_IncRef(value);
      inerter_python.PyList_SetItem(row, k, value);
    }
  }
  for (int32_t i = 0; i < element->ndistinct; i++) inerter_python.Py_DecRef(made[i]);
  return 0;
}

static void write_array(const InerterElement* element) {
  const double* values = element->tape.values;
  const int32_t* entry = element->entries;
  for (int32_t i = 0; i < element->nrow; i++) {
    double* row = element->mass + (ptrdiff_t)i * element->size;
    for (int32_t k = 0; k < element->nrow; k++) row[k] = values[element->distinct[*entry++]];
  }
}

static Object* mass(Object* self, Object* arguments) {
  InerterElement* element = element_of(self);
  if (!element || update(element, arguments)) {
    return NULL;
  }
  Object* matrix = element->mass_array;
  if (element->mass_list != element->none) {
    matrix = element->mass_list;
    if (write_lists(element)) {
      return NULL;
    }
  } else {
    write_array(element);
  }
  inerter_python.Py_IncRef(matrix);
  return matrix;
}

// put a matrix into a list of lists; 0, or -1 with an error set
static int list_matrix(const double* matrix, int32_t n, Object* lists) {
  for (int32_t i = 0; i < n; i++) {
    Object* row = inerter_python.PyList_GetItem(lists, i);
    for (int32_t k = 0; k < n; k++) {
      Object* value = inerter_python.PyFloat_FromDouble(*matrix++);
      if (!value) {
        return -1;
      }
      inerter_python.PyList_SetItem(row, k, value);
    }
  }
  return 0;
}

static Object* jacobian(Object* self, Object* arguments) {
  InerterElement* element = element_of(self);
  if (!element || update(element, arguments)) {
    return NULL;
  }
  double by_place = inerter_python.PyFloat_AsDouble(inerter_python.PyTuple_GetItem(arguments, 5));
  double by_speed = inerter_python.PyFloat_AsDouble(inerter_python.PyTuple_GetItem(arguments, 6));
  if (inerter_python.PyErr_Occurred()) {
    return NULL;
  }
  inerter_tape_slopes(&element->tape);
  const int32_t n = element->size;
  for (int32_t i = 0; i < n; i++) {
    const double* slope =
        element->tape.slopes + (ptrdiff_t)element->forces[i] * element->tape.ninput;
    double* row = element->jacobian + (ptrdiff_t)i * n;
    for (int32_t k = 0; k < n; k++) row[k] = -by_place * slope[k] - by_speed * slope[n + k];
  }
  Object* matrix = element->jacobian_array;
  if (element->jacobian_list != element->none) {
    matrix = element->jacobian_list;
    if (list_matrix(element->jacobian, n, matrix)) {
      return NULL;
    }
  }
  inerter_python.Py_IncRef(matrix);
  return matrix;
}

static Method methods[] = {
    {"forceUserFunction", force, INERTER_METHOD_ARGUMENTS, "forces (mbs, t, itemNumber, q, q_t)"},
    {"massMatrixUserFunction", mass, INERTER_METHOD_ARGUMENTS, "M (mbs, t, itemNumber, q, q_t)"},
    {"jacobianUserFunction", jacobian, INERTER_METHOD_ARGUMENTS,
     "K (mbs, t, itemNumber, q, q_t, factor, factor_t)"},
};

// hand over Python's functions, in the order of INERTER_PYTHON
INERTER_API void inerter_exudyn_begin(const Python* functions) {
  inerter_python = *functions;
}

// the method of a number: force, mass matrix, Jacobian, sensor
INERTER_API Method* inerter_exudyn_method(int number) {
  int count = (int)(sizeof methods / sizeof *methods);
  if (number == count) {
    return &inerter_sensor_method;
  }
  return number >= 0 && number < count ? methods + number : NULL;
}

// the name of an operation, or NULL past the last
INERTER_API const char* inerter_exudyn_operation(int number) {
  static const char* const names[] = {
#define X(name, expression) #name,
      INERTER_OPERATIONS(X)
#undef X
  };
  return number >= 0 && number < INERTER_NOPERATION ? names[number] : NULL;
}

INERTER_API int inerter_exudyn_listed(void) {
  return INERTER_LISTED;
}

INERTER_API void inerter_exudyn_run(const InerterTape* tape) {
  inerter_tape_run(tape);
}

INERTER_API void inerter_exudyn_run_slopes(const InerterTape* tape) {
  inerter_tape_slopes(tape);
}
