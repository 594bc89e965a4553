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
    given[DRIVE] = joint->driven;
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
    joint->driven = joint->input[CURRENT];
    given_now(joint, given);
    evaluate(initial, joint->heat, given, joint->heat, 0);
    joint->step = FIRST_STEP;
    joint->angle = joint->input[ANGLE];
    torque_start(joint);
    joint_observe(joint);
    joint->thermistor = joint->observed[NEAR_FACE];
    joint->controlling = 0;
}

/* What a first-order lag shows after some seconds over which what it reads changes evenly. */
static double lagged(double shown, double before, double now, double seconds, double lag)
{
    double slope = (now - before) / seconds;
    return now - slope * lag + (shown - before + slope * lag) * exp(-seconds / lag);
}

static int advance_part(Joint *joint, double current, double air, double angle, double seconds)
{
    if (!heat_advance(joint, current, air, seconds)) return 0;
    torque_advance(joint, angle, seconds);
    return 1;
}

/* The controller steps every PERIOD; its driver follows with a lag of its own. */
static int advance_controlled(Joint *joint, double seconds)
{
#if CONTROLLED
    double from = joint->angle, to = joint->input[ANGLE] + joint->slope[ANGLE] * seconds, done = 0.0;
    if (!joint->controlling) controller_start(&joint->controller, (real)joint->thermistor);
    if (!joint->controlling) joint->due = 0.0;
    joint->controlling = 1;
    while (seconds - done > 1e-9 * seconds) {
        double length, rest, mean, before = joint->observed[NEAR_FACE];
        if (joint->due <= 1e-9 * PERIOD) {
            joint->requested = controller_step(&joint->controller, (real)joint->thermistor, (real)joint->input[COMMAND]);
            joint->due = PERIOD;
        }
        length = fmin(fmin(joint->due, LONGEST_STEP), seconds - done);
        rest = exp(-length / DRIVER_LAG);
        mean = joint->requested + (joint->driven - joint->requested) * DRIVER_LAG / length * (1.0 - rest);
        joint->driven = joint->requested + (joint->driven - joint->requested) * rest;
        done += length;
        joint->due -= length;
        if (!advance_part(joint, mean, joint->input[AMBIENT], from + (to - from) * done / seconds, length)) return 0;
        joint_observe(joint);
        joint->thermistor =
            lagged(joint->thermistor, before, joint->observed[NEAR_FACE], length, joint->thermistor_lag);
    }
    return 1;
#else
    (void)joint, (void)seconds, (void)advance_part;
    return 0;
#endif
}

static int advance_driven(Joint *joint, double seconds)
{
    double from = joint->angle, to = joint->input[ANGLE] + joint->slope[ANGLE] * seconds;
    double before = joint->observed[NEAR_FACE];
    int parts = (int)ceil(seconds / LONGEST_STEP), part;
    if (parts < 1) parts = 1;
    joint->driven = joint->input[CURRENT];
    joint->controlling = 0;
    for (part = 1; part <= parts; part++) {
        double length = seconds / parts, middle = (part - 0.5) * length;
        double current = joint->input[CURRENT] + joint->slope[CURRENT] * middle;
        double air = joint->input[AMBIENT] + joint->slope[AMBIENT] * middle;
        if (!advance_part(joint, current, air, from + (to - from) * part / parts, length)) return 0;
    }
    joint->driven = joint->input[CURRENT] + joint->slope[CURRENT] * seconds;
    joint_observe(joint);
    joint->thermistor = lagged(joint->thermistor, before, joint->observed[NEAR_FACE], seconds, joint->thermistor_lag);
    return 1;
}

int joint_advance(Joint *joint, double seconds)
{
    int part;
    if (!(joint->input[COMMAND] > 0.0 ? advance_controlled : advance_driven)(joint, seconds)) return 0;
    for (part = 0; part < INPUTS; part++) {
        joint->input[part] += joint->slope[part] * seconds;
        joint->slope[part] = 0.0;
    }
    joint->time += seconds;
    joint_observe(joint);
    return 1;
}
