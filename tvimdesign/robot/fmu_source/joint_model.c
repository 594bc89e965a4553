/* The joint's heat and torque together, and the equations evaluated. */
#include "joint_model.h"

#include <math.h>
#include <string.h>

void evaluate(Equation equation, const double *state, const double *given, double *first, double *second)
{
    const double *arguments[WORK_ARGUMENTS] = {state, given};
    double *results[WORK_RESULTS] = {first, second};
    casadi_int integers[WORK_INTEGERS];
    double work[WORK_NUMBERS];
    equation(arguments, results, integers, work, 0);
}

static void given_now(const Joint *joint, double *given)
{
    given[DRIVE] = joint->input[CURRENT];
    given[AIR] = joint->input[AMBIENT];
    given[FREQUENCY] = joint->frequency;
}

void joint_observe(Joint *joint)
{
    double given[GIVEN];
    given_now(joint, given);
    evaluate(observed, joint->heat, given, joint->observed, 0);
}

void joint_start(Joint *joint)
{
    double given[GIVEN];
    given_now(joint, given);
    evaluate(initial, joint->heat, given, joint->heat, 0);
    joint->step = FIRST_STEP;
    joint->angle = joint->input[ANGLE];
    torque_start(joint);
    joint_observe(joint);
}

int joint_advance(Joint *joint, double seconds)
{
    double from = joint->angle, to = joint->input[ANGLE] + joint->slope[ANGLE] * seconds;
    int parts = (int)ceil(seconds / LONGEST_STEP), part;
    if (parts < 1) parts = 1;
    for (part = 1; part <= parts; part++) {
        double length = seconds / parts, middle = (part - 0.5) * length;
        double current = joint->input[CURRENT] + joint->slope[CURRENT] * middle;
        double air = joint->input[AMBIENT] + joint->slope[AMBIENT] * middle;
        if (!heat_advance(joint, current, air, length)) return 0;
        torque_advance(joint, from + (to - from) * part / parts, length);
    }
    for (part = 0; part < INPUTS; part++) {
        joint->input[part] += joint->slope[part] * seconds;
        joint->slope[part] = 0.0;
    }
    joint->time += seconds;
    joint_observe(joint);
    return 1;
}
