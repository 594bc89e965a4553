/* The joint behind the interface of FMI 2.0 for co-simulation.
   Source: Functional Mock-up Interface for Model Exchange and Co-Simulation 2.0.4, sec. 2 and 4. */
#include "joint_model.h"

#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED __attribute__((visibility("default")))
#endif

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef unsigned int Reference;
typedef void (*Logger)(void *environment, const char *name, fmi2Status status, const char *category,
                       const char *message, ...);

typedef struct {
    Logger logger;
    void *(*allocate)(size_t count, size_t size);
    void (*release)(void *memory);
    void (*step_finished)(void *environment, fmi2Status status);
    void *environment;
} Callbacks;

typedef struct {
    Joint joint;
    int initialized;
    Callbacks callbacks;
    char name[128];
} Instance;

/* Value references: inputs, the frequency, the thermistor's lag, the torque, what is observed, control, constants. */
enum { R_FREQUENCY = INPUTS, R_LAG, R_TORQUE, R_OBSERVED, R_CONTROL = R_OBSERVED + OBSERVED, R_CONSTANTS = R_CONTROL + 3 };

static fmi2Status refuse(Instance *me, const char *message)
{
    if (me->callbacks.logger)
        me->callbacks.logger(me->callbacks.environment, me->name, fmi2Error, "logStatusError", "%s", message);
    return fmi2Error;
}

static void at_start(Joint *joint)
{
    memset(joint, 0, sizeof *joint);
    memcpy(joint->input, input_start, sizeof joint->input);
    joint->frequency = FREQUENCY_START;
    joint->thermistor_lag = THERMISTOR_LAG_START;
    joint_start(joint);
}

EXPORTED const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORTED const char *fmi2GetVersion(void) { return "2.0"; }
EXPORTED fmi2Status fmi2SetDebugLogging(void *c, int on, size_t count, const char *const *categories)
{
    (void)c, (void)on, (void)count, (void)categories;
    return fmi2OK;
}

EXPORTED void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                               const Callbacks *callbacks, int visible, int logging)
{
    Instance *me;
    (void)resources, (void)visible, (void)logging;
    if (type != 1 || strcmp(guid, GUID)) {
        if (callbacks && callbacks->logger)
            callbacks->logger(callbacks->environment, name, fmi2Error, "logStatusError",
                              type != 1 ? "the joint is an FMU for co-simulation" : "the GUID is of another FMU");
        return NULL;
    }
    me = calloc(1, sizeof *me);
    if (!me) return NULL;
    if (callbacks) me->callbacks = *callbacks;
    if (name) strncpy(me->name, name, sizeof me->name - 1);
    at_start(&me->joint);
    return me;
}

EXPORTED void fmi2FreeInstance(void *c) { free(c); }

EXPORTED fmi2Status fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int has_stop,
                                        double stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    ((Instance *)c)->joint.time = start;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2EnterInitializationMode(void *c) { (void)c; return fmi2OK; }

EXPORTED fmi2Status fmi2ExitInitializationMode(void *c)
{
    Instance *me = c;
    joint_start(&me->joint);
    me->initialized = 1;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2Terminate(void *c) { (void)c; return fmi2OK; }

EXPORTED fmi2Status fmi2Reset(void *c)
{
    Instance *me = c;
    at_start(&me->joint);
    me->initialized = 0;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetReal(void *c, const Reference *references, size_t count, double *values)
{
    Instance *me = c;
    const Joint *joint = &me->joint;
    size_t i;
    if (!me->initialized) joint_start(&me->joint);   /* start values may have been set since */
    for (i = 0; i < count; i++) {
        Reference r = references[i];
        if (r < INPUTS) values[i] = joint->input[r];
        else if (r == R_FREQUENCY) values[i] = joint->frequency;
        else if (r == R_LAG) values[i] = joint->thermistor_lag;
        else if (r == R_TORQUE) values[i] = joint->torque;
        else if (r < R_OBSERVED + OBSERVED) values[i] = joint->observed[r - R_OBSERVED];
        else if (r == R_CONTROL) values[i] = joint->driven;
        else if (r == R_CONTROL + 1) values[i] = joint->thermistor;
        else if (r == R_CONTROL + 2) values[i] = joint->controlling ? joint->controller.impedance : 0.0;
        else if (r < R_CONSTANTS + CONSTANTS) values[i] = constants[r - R_CONSTANTS];
        else return refuse(me, "fmi2GetReal: no variable has this value reference");
    }
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetReal(void *c, const Reference *references, size_t count, const double *values)
{
    Instance *me = c;
    size_t i;
    for (i = 0; i < count; i++) {
        if (references[i] == COMMAND && values[i] > 0.0 && !CONTROLLED)
            return refuse(me, "impedance_command: the module never gets soft, so it has no controller");
        if (references[i] < INPUTS) me->joint.input[references[i]] = values[i];
        else if (references[i] == R_FREQUENCY) {
            if (!(values[i] > 0.0)) return refuse(me, "frequency: must be above 0 Hz");
            me->joint.frequency = values[i];
        } else if (references[i] == R_LAG) {
            if (!(values[i] > 0.0)) return refuse(me, "thermistor_lag: must be above 0 s");
            me->joint.thermistor_lag = values[i];
        } else return refuse(me, "fmi2SetReal: only inputs, the frequency and the thermistor's lag can be set");
    }
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetRealInputDerivatives(void *c, const Reference *references, size_t count, const int *orders,
                                                const double *values)
{
    Instance *me = c;
    size_t i;
    for (i = 0; i < count; i++) {
        if (references[i] >= INPUTS || orders[i] != 1)
            return refuse(me, "fmi2SetRealInputDerivatives: takes first derivatives of inputs");
        me->joint.slope[references[i]] = values[i];
    }
    return fmi2OK;
}

EXPORTED fmi2Status fmi2DoStep(void *c, double time, double step, int keeps)
{
    Instance *me = c;
    (void)keeps;
    if (!(step > 0.0)) return step == 0.0 ? fmi2OK : refuse(me, "fmi2DoStep: the step must not be negative");
    me->joint.time = time;
    if (joint_advance(&me->joint, step)) return fmi2OK;
    return refuse(me, "fmi2DoStep: the heat equation cannot be integrated; look at the current and the ambient");
}

EXPORTED fmi2Status fmi2GetFMUstate(void *c, void **state)
{
    if (!*state) *state = malloc(sizeof(Joint) + sizeof(int));
    if (!*state) return refuse(c, "fmi2GetFMUstate: no memory");
    memcpy(*state, &((Instance *)c)->joint, sizeof(Joint));
    memcpy((char *)*state + sizeof(Joint), &((Instance *)c)->initialized, sizeof(int));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetFMUstate(void *c, void *state)
{
    memcpy(&((Instance *)c)->joint, state, sizeof(Joint));
    memcpy(&((Instance *)c)->initialized, (char *)state + sizeof(Joint), sizeof(int));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2FreeFMUstate(void *c, void **state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SerializedFMUstateSize(void *c, void *state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(Joint) + sizeof(int);
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SerializeFMUstate(void *c, void *state, char *bytes, size_t size)
{
    if (size < sizeof(Joint) + sizeof(int)) return refuse(c, "fmi2SerializeFMUstate: too little room");
    memcpy(bytes, state, sizeof(Joint) + sizeof(int));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t size, void **state)
{
    if (size != sizeof(Joint) + sizeof(int)) return refuse(c, "fmi2DeSerializeFMUstate: of another FMU");
    if (!*state) *state = malloc(size);
    if (!*state) return refuse(c, "fmi2DeSerializeFMUstate: no memory");
    memcpy(*state, bytes, size);
    return fmi2OK;
}

/* What the joint has none of: the interface asks for the functions all the same. */
static fmi2Status none(void *c, size_t count, const char *message) { return count ? refuse(c, message) : fmi2OK; }
static const char NO_INTEGERS[] = "the joint has variables of type Real alone";

EXPORTED fmi2Status fmi2GetInteger(void *c, const Reference *r, size_t count, int *v)
{ (void)r, (void)v; return none(c, count, NO_INTEGERS); }
EXPORTED fmi2Status fmi2GetBoolean(void *c, const Reference *r, size_t count, int *v)
{ (void)r, (void)v; return none(c, count, NO_INTEGERS); }
EXPORTED fmi2Status fmi2GetString(void *c, const Reference *r, size_t count, const char **v)
{ (void)r, (void)v; return none(c, count, NO_INTEGERS); }
EXPORTED fmi2Status fmi2SetInteger(void *c, const Reference *r, size_t count, const int *v)
{ (void)r, (void)v; return none(c, count, NO_INTEGERS); }
EXPORTED fmi2Status fmi2SetBoolean(void *c, const Reference *r, size_t count, const int *v)
{ (void)r, (void)v; return none(c, count, NO_INTEGERS); }
EXPORTED fmi2Status fmi2SetString(void *c, const Reference *r, size_t count, const char *const *v)
{ (void)r, (void)v; return none(c, count, NO_INTEGERS); }
EXPORTED fmi2Status fmi2GetDirectionalDerivative(void *c, const Reference *unknown, size_t unknowns,
                                                 const Reference *known, size_t count, const double *seed, double *v)
{ (void)unknown, (void)unknowns, (void)known, (void)seed, (void)v; return none(c, count, "no directional derivatives"); }
EXPORTED fmi2Status fmi2GetRealOutputDerivatives(void *c, const Reference *r, size_t count, const int *o, double *v)
{ (void)r, (void)o, (void)v; return none(c, count, "no derivatives of outputs"); }
EXPORTED fmi2Status fmi2CancelStep(void *c) { return none(c, 1, "no step is pending"); }
EXPORTED fmi2Status fmi2GetStatus(void *c, int kind, fmi2Status *v)
{ (void)kind, (void)v; return none(c, 1, "no step is pending"); }
EXPORTED fmi2Status fmi2GetRealStatus(void *c, int kind, double *v)
{ if (kind != 2) return none(c, 1, "no step is pending"); *v = ((Instance *)c)->joint.time; return fmi2OK; }
EXPORTED fmi2Status fmi2GetIntegerStatus(void *c, int kind, int *v)
{ (void)kind, (void)v; return none(c, 1, "no step is pending"); }
EXPORTED fmi2Status fmi2GetBooleanStatus(void *c, int kind, int *v)
{ if (kind != 3) return none(c, 1, "no step is pending"); (void)v; *v = 0; return fmi2OK; }
EXPORTED fmi2Status fmi2GetStringStatus(void *c, int kind, const char **v)
{ (void)kind, (void)v; return none(c, 1, "no step is pending"); }
