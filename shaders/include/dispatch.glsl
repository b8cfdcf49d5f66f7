// Where a thread stands in the whole of a dispatch, which Program::dispatch may have split by what the
// device launches at once: kernels ask here, and not the built-in indices of one launch.
uniform uvec3 first_group;

uvec3 work_group() { return first_group + gl_WorkGroupID; }

// gl_WorkGroupSize must have been declared where this stands.
#define invocation() (work_group() * gl_WorkGroupSize + gl_LocalInvocationID)
