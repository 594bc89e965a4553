/* The joint that an FMU simulates: its heat, and the torque at its angle. SI units: s, A, K, rad, N.m. */
#ifndef JOINT_MODEL_H
#define JOINT_MODEL_H

#include "sizes.h"
#include "equations.h"
#include "controller.h"

/* What is given from outside, in the order of the value references. */
enum { CURRENT, ANGLE, AMBIENT, COMMAND, INPUTS };
/* What the equations take beside the state. */
enum { DRIVE, AIR, FREQUENCY, GIVEN };

/* The PCL that pushes back on one side, with the structure behind it; the bonded layer is one side that also pulls. */
typedef struct {
    double face;                      /* angle at which its face stands [rad] */
    double slice[CELLS][MODES];       /* torque of each Maxwell element of each slice [N.m] */
    double structure[ELEMENTS + 1];   /* torque of the structure's elements, its spring last [N.m] */
} Side;

typedef struct {
    double time;
    double input[INPUTS], slope[INPUTS];
    double frequency, thermistor_lag;
    double heat[STATES];
    double step;                      /* the next that the heat's integration tries [s] */
    double angle;                     /* of the link now [rad] */
    Side side[SIDES];
    double stiffness[CELLS][MODES];   /* of the elements when the torques were last found [N.m/rad] */
    double support[ELEMENTS + 1];
    double observed[OBSERVED];
    Controller controller;            /* runs while COMMAND is above zero */
    int controlling;
    double due, requested;            /* until its next step [s]; what it asked for in the last [A] */
    double driven, thermistor;        /* current in the heater [A]; reading [K] */
    double torque;                    /* that the joint puts on what moves [N.m] */
} Joint;

void joint_start(Joint *joint);
/* Go on by some seconds; 0 where the heat equation cannot be integrated. */
int joint_advance(Joint *joint, double seconds);
void joint_observe(Joint *joint);

int heat_advance(Joint *joint, double current, double air, double seconds);
void torque_start(Joint *joint);
void torque_advance(Joint *joint, double angle, double seconds);

/* One of the generated equations: arguments state and given, up to two results. */
typedef int (*Equation)(const double **arguments, double **results, casadi_int *integers, double *work, int memory);
void evaluate(Equation equation, const double *state, const double *given, double *first, double *second);

#endif
