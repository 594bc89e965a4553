/* The torque at the joint's angle: slices of PCL in series with the structure, each a body of Maxwell elements.

   Over a step in which a body is turned evenly by d, an element of torque t, stiffness k and relaxation time tau comes
   to t exp(-h/tau) + k d (1 - exp(-h/tau)) tau/h: exact, so a step may be longer than any relaxation time. Bodies in
   series bear one torque, which is linear in the turn of the whole. What gets softer keeps its strain, so its torque
   falls with its stiffness; what freezes is free of stress as it freezes, so its torque stays. */
#include "joint_model.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

typedef struct {
    double stiffness[CELLS][MODES], time[CELLS][MODES];
    double support[ELEMENTS + 1];
    double springs;
} Properties;

/* What is the stiffness of an element at the torque it has, once it is another: never more torque than before. */
static double kept(double before, double now) { return now < before ? now / before : 1.0; }

/* Elements and spring of a structure that loses the same share at every pace, (i w)^a with a = 2/pi atan(K''/K'):
   strengths that go as time^-a (Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 4), as strong as its loss is
   at the frequency, and a spring for what is slower than all of them. */
static void structure_now(double stiffness, double loss, double frequency, double *support)
{
    double power = 2.0 / PI * atan2(loss, stiffness), stored = 0.0, lost = 0.0, share;
    int i;
    for (i = 0; i < ELEMENTS; i++) {
        double turn = 2.0 * PI * frequency * support_time[i];
        support[i] = pow(support_time[i], -power);
        stored += support[i] * turn * turn / (1.0 + turn * turn);
        lost += support[i] * turn / (1.0 + turn * turn);
    }
    share = loss > 0.0 ? loss / lost : 0.0;
    for (i = 0; i < ELEMENTS; i++) support[i] *= share;
    support[ELEMENTS] = fmax(stiffness - share * stored, 0.0);
}

static void properties_now(const Joint *joint, Properties *now)
{
    double given[GIVEN], flat[2 * CELLS * MODES + 3];
    const double *support = flat + 2 * CELLS * MODES;
    given[DRIVE] = joint->driven;
    given[AIR] = joint->input[AMBIENT];
    given[FREQUENCY] = joint->frequency;
    evaluate(mechanics, joint->heat, given, flat, 0);
    memcpy(now->stiffness, flat, sizeof now->stiffness);
    memcpy(now->time, flat + CELLS * MODES, sizeof now->time);
    now->springs = support[2];
    structure_now(support[0], support[1], joint->frequency, now->support);
}

/* Torque an element has after a step without a turn, and what it gains by a turn of one. */
static void element(double torque, double stiffness, double time, double seconds, double *rest, double *gain)
{
    double steps = seconds / time;
    *rest = torque * exp(-steps);
    *gain = stiffness * (steps > 1e-9 ? -expm1(-steps) / steps : 1.0);
}

static void body(const double *torques, const double *stiffnesses, const double *times, int count, double seconds,
                 double *rest, double *gain)
{
    int i;
    *rest = *gain = 0.0;
    for (i = 0; i < count; i++) {
        double own, more;
        element(torques[i], stiffnesses[i], times[i], seconds, &own, &more);
        *rest += own;
        *gain += more;
    }
}

static void turn_body(double *torques, const double *stiffnesses, const double *times, int count, double seconds,
                      double turn)
{
    int i;
    for (i = 0; i < count; i++) {
        double own, more;
        element(torques[i], stiffnesses[i], times[i], seconds, &own, &more);
        torques[i] = own + more * turn;
    }
}

/* Torque of a side whose face, if it touches, is turned to `angle`. */
static double push(Side *side, const Properties *now, double angle, double seconds)
{
    double rest[CELLS + 1], gain[CELLS + 1], free_turn = 0.0, give = 0.0, torque, turn = angle - side->face;
    int i;
    for (i = 0; i < CELLS; i++)
        body(side->slice[i], now->stiffness[i], now->time[i], MODES, seconds, &rest[i], &gain[i]);
    body(side->structure, now->support, support_time, ELEMENTS + 1, seconds, &rest[CELLS], &gain[CELLS]);
    for (i = 0; i <= CELLS; i++) {
        free_turn -= rest[i] / gain[i];
        give += 1.0 / gain[i];
    }
    torque = (turn - free_turn) / give;
    if (SIDES > 1 && torque < 0.0) {   /* it only pushes: its face recovers and stays behind */
        torque = 0.0;
        turn = free_turn;
    }
    for (i = 0; i < CELLS; i++)
        turn_body(side->slice[i], now->stiffness[i], now->time[i], MODES, seconds, (torque - rest[i]) / gain[i]);
    turn_body(side->structure, now->support, support_time, ELEMENTS + 1, seconds,
              (torque - rest[CELLS]) / gain[CELLS]);
    side->face += turn;
    return torque;
}

static void soften(Joint *joint, const Properties *now)
{
    int s, i, j;
    for (s = 0; s < SIDES; s++) {
        Side *side = &joint->side[s];
        for (i = 0; i < CELLS; i++)
            for (j = 0; j < MODES; j++) side->slice[i][j] *= kept(joint->stiffness[i][j], now->stiffness[i][j]);
        for (j = 0; j <= ELEMENTS; j++) side->structure[j] *= kept(joint->support[j], now->support[j]);
    }
    memcpy(joint->stiffness, now->stiffness, sizeof now->stiffness);
    memcpy(joint->support, now->support, sizeof now->support);
}

void torque_start(Joint *joint)
{
    Properties now;
    int s;
    properties_now(joint, &now);
    memset(joint->side, 0, sizeof joint->side);
    memcpy(joint->stiffness, now.stiffness, sizeof now.stiffness);
    memcpy(joint->support, now.support, sizeof now.support);
    for (s = 0; s < SIDES; s++) joint->side[s].face = s == 0 ? joint->angle : -joint->angle;
    joint->torque = -now.springs * joint->angle;
}

void torque_advance(Joint *joint, double angle, double seconds)
{
    Properties now;
    int s;
    properties_now(joint, &now);
    soften(joint, &now);
    joint->angle = angle;
    joint->torque = -now.springs * angle;
    for (s = 0; s < SIDES; s++) {
        double sense = s == 0 ? 1.0 : -1.0;
        joint->torque -= sense * push(&joint->side[s], &now, sense * angle, seconds);
    }
}
