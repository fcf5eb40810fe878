// The user function of a sensor: what it tells is evaluated on a tape of the readings.
//
// Exudyn is asked for the coordinates of the whole system, in which those of the object are found
// by their numbers: that is three times quicker than to ask for those of the object alone. Where
// the numbers are not known, and where what is read is not finite, a function in Python takes over.

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "exudyn/python.h"
#include "exudyn/tape.h"

enum { INERTER_KINDS = 3 };  // coordinates, their rates, theirs

typedef struct InerterSensor_ {
  const InerterTape* tape;          // inputs: INERTER_KINDS times `size` numbers
  int32_t size;                     // coordinates of the object
  int32_t ntold;                    // values that the sensor tells
  int32_t total;                    // coordinates of the system
  int32_t needed[INERTER_KINDS];    // whether the tape depends on that kind
  const int32_t* places;            // of what is told, on the tape; ntold
  const int32_t* coordinates;       // the object's among those of the system, size; or NULL
  Object* data;                     // "systemData"
  Object* question[INERTER_KINDS];  // names of its functions that tell of all coordinates
  Object* whole;                    // the same in Python, of the same arguments
} InerterSensor;

// copy the object's numbers out of an array of the system's; whether that was possible
static int pick(const InerterSensor* sensor, Object* array, double* to) {
  Buffer view;
  if (inerter_python.PyObject_GetBuffer(array, &view, INERTER_BUFFER_SIMPLE)) {
    return -1;
  }
  int fits = view.length == (ptrdiff_t)sizeof(double) * sensor->total;
  const double* from = view.data;
  for (int32_t i = 0; fits && i < sensor->size; i++) to[i] = from[sensor->coordinates[i]];
  inerter_python.PyBuffer_Release(&view);
  return fits;
}

// bring the inputs to a configuration; 1, 0 if the numbers do not fit, -1 with an error set
static int read(const InerterSensor* sensor, Object* system, Object* configuration) {
  Object* data = inerter_python.PyObject_GetAttr(system, sensor->data);
  int done = data ? 1 : -1;
  for (int k = 0; done == 1 && k < INERTER_KINDS; k++) {
    if (!sensor->needed[k]) {
      continue;
    }
    Object* found = inerter_python.PyObject_CallMethodObjArgs(data, sensor->question[k],
                                                              configuration, (Object*)NULL);
    done = found ? pick(sensor, found, sensor->tape->values + (ptrdiff_t)k * sensor->size) : -1;
    if (found) {
      inerter_python.Py_DecRef(found);
    }
  }
  if (data) {
    inerter_python.Py_DecRef(data);
  }
  return done;
}

// (mbs, t, sensorNumbers, factors, configuration) -> list of values
static Object* tell(Object* self, Object* arguments) {
  InerterSensor* sensor = inerter_python.PyLong_AsVoidPtr(inerter_python.PyTuple_GetItem(self, 0));
  Object* system = inerter_python.PyTuple_GetItem(arguments, 0);
  Object* configuration = inerter_python.PyTuple_GetItem(arguments, 4);
  if (!sensor || !system || !configuration) {
    return NULL;
  }
  int done = sensor->coordinates ? read(sensor, system, configuration) : 0;
  if (done < 0) {
    return NULL;
  }
  if (!done) {
    sensor->coordinates = NULL;
    return inerter_python.PyObject_CallObject(sensor->whole, arguments);
  }
  inerter_tape_run(sensor->tape);
  const double* values = sensor->tape->values;
  double sum = 0.0;
  for (int32_t i = 0; i < sensor->ntold; i++) sum += values[sensor->places[i]];
  if (!isfinite(sum)) {
    return inerter_python.PyObject_CallObject(sensor->whole, arguments);
  }
  Object* list = inerter_python.PyList_New(sensor->ntold);
  for (int32_t i = 0; list && i < sensor->ntold; i++) {
    Object* value = inerter_python.PyFloat_FromDouble(values[sensor->places[i]]);
    inerter_python.PyList_SetItem(list, i, value);
  }
  return list;
}

Method inerter_sensor_method = {"sensorUserFunction", tell, INERTER_METHOD_ARGUMENTS,
                                "readings (mbs, t, sensorNumbers, factors, configuration)"};
