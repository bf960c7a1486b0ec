// SPDX-License-Identifier: Apache-2.0
// A component of Unity: runs a patch live and moves an object where the tool of the patch is. Unity is left-handed with y up; a patch is
// right-handed with z up.
#if UNITY_5_3_OR_NEWER
using UnityEngine;

namespace Tactus
{
    public sealed class TactusHand : MonoBehaviour
    {
        public string patchName = "touch-sphere";
        public string pose = "coupling.pose";

        private Patch patch;
        private Run run;

        private void OnEnable()
        {
            patch = new Patch(patchName);
            run = patch.Start(live: true);
        }

        private void Update()
        {
            double[] p = run.Newest(pose);
            transform.localPosition = new Vector3((float)p[0], (float)p[2], (float)p[1]);
            transform.localRotation = new Quaternion(-(float)p[4], -(float)p[6], -(float)p[5], (float)p[3]);
        }

        private void OnDisable()
        {
            // OnEnable may have failed.
            run?.Finish();
            run?.Dispose();
            patch?.Dispose();
            run = null;
            patch = null;
        }
    }
}
#endif
