/* The joint's controller: current of its heater from a thermistor at the layer's hot face, for an impedance that is
   asked for. The same file runs in the FMU and on a microcontroller; its constants are those of the module. SI units. */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "controller_constants.h"

#ifndef CONTROLLER_REAL
#define CONTROLLER_REAL double   /* float where the processor has no other */
#endif
typedef CONTROLLER_REAL real;

typedef struct {
    real sensed, near, drift;        /* observer: thermistor [K], layer's hot face [K], rate the model lacks [K/s] */
    real enthalpy[LAYER_CELLS];      /* of the layer's cells, hot face first [J/kg] */
    real behind, ambient;            /* what is behind the layer; at the start [K] */
    real integral, current;          /* [A] */
    real time;                       /* since heating began [s] */
    real impedance;                  /* of the joint, estimated [N.m/rad] */
} Controller;

/* Start with the joint at rest, everywhere at the temperature that the thermistor has [K]. */
void controller_start(Controller *c, real thermistor);
/* Call every PERIOD seconds with the thermistor's temperature [K]; the heater's current [A], below zero to cool. */
real controller_step(Controller *c, real thermistor, real impedance);

#endif
