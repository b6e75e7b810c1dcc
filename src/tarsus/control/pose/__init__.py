"""Body pose while walking: filtering, levelling, heading, stance on slopes; compliant and rolling feet, deflection."""
